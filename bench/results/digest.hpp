// Short names for texts: the head of a SHA-256.
#pragma once

#include <string>
#include <string_view>

namespace corridor::results {

// The first 12 hexadecimal digits (48 bits): enough to tell some ten thousand cases apart.
std::string short_digest(std::string_view text);

}  // namespace corridor::results
