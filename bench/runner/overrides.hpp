// Parameters set by hand, in a suite or with --set, checked against the system they are for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench/runner/systems.hpp"

namespace corridor::runner {

// The names that are nearest to a misspelt one, the nearest first: at most three, by edit distance
// [Levenshtein1966]; a name that holds the misspelt one, or is held by it, counts as near.
std::vector<std::string> nearest_names(std::string_view misspelt,
                                       const std::vector<std::string>& names);

// Every value of the system's parameters. The Error lists all unknown names, each with those it may
// have been meant for, and all broken rules.
Result<ParamValues> resolve_overrides(const SystemInfo& info, const std::string& profile,
                                      const ParamValues& overrides);

}  // namespace corridor::runner
