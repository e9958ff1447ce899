// Between the units of files and reports and those of the code, and standard gravity.
#pragma once

#include <numbers>

namespace corridor {

inline constexpr double kRadPerDeg = std::numbers::pi / 180;
inline constexpr double kDegPerRad = 180 / std::numbers::pi;
inline constexpr double kGravity_mps2 = 9.80665;  // standard acceleration of free fall

}  // namespace corridor
