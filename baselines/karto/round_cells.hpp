// Rounding to whole cells, inline: it runs for every end point of every match.
#pragma once

#include <cmath>
#include <cstdint>

namespace corridor::karto {

// Nearest integer, halves away from zero, like std::lround but without the call.
inline std::int32_t round_to_cell(double cells) {
  return static_cast<std::int32_t>(std::trunc(cells + std::copysign(0.5, cells)));
}

}  // namespace corridor::karto
