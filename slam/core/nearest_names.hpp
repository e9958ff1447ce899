// What a misspelt name may have been meant for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace corridor {

// The names that are nearest to a misspelt one, the nearest first: at most three, by edit distance
// [Levenshtein1966]; a name that holds the misspelt one, or is held by it, counts as near.
std::vector<std::string> nearest_names(std::string_view misspelt,
                                       const std::vector<std::string>& names);

}  // namespace corridor
