// One reading of the wheel odometry.
#pragma once

#include <cstdint>
#include <optional>

#include "slam/core/pose2.hpp"
#include "slam/core/timestamp.hpp"

namespace corridor {

struct WheelTicks {
  std::int64_t left = 0;  // cumulative since the start of the log
  std::int64_t right = 0;
};

// The pose is what the robot's own odometry integrated since some origin: only differences between
// two samples mean anything. Ticks are kept where the log has them.
struct WheelSample {
  Timestamp stamp;
  Pose2 T_odom_base;
  std::optional<WheelTicks> ticks;
};

}  // namespace corridor
