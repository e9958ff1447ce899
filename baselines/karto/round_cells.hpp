// Rounding to grid cells, the same everywhere: a point on the edge of two cells must not depend on
// who rounds it. A changed cell changes a match.
#pragma once

#include <cmath>
#include <cstdint>

namespace corridor::karto {

// Nearest integer, halves away from zero, like std::lround but without the call; requires a value
// that fits. The conversion cuts off the decimals, and loops of it become vectors.
inline std::int32_t round_to_cell(double cells) {
  return static_cast<std::int32_t>(cells + std::copysign(0.5, cells));
}

}  // namespace corridor::karto
