// Poses of the scans between two key scans, from odometry and the key scans' final poses.
#pragma once

#include "slam/core/pose2.hpp"

namespace corridor::karto {

// A pose known in both frames.
struct Anchor {
  Pose2 T_odom_base;
  Pose2 T_map_base;

  // Where the base is in the map when odometry says T_odom_base, by odometry since the anchor.
  [[nodiscard]] Pose2 carried_to(const Pose2& T_odom_base_now) const {
    return T_map_base * T_odom_base.between(T_odom_base_now);
  }
};

// Mean of odometry carried on from the earlier key scan and carried back from the later one, weight of
// the later = `ratio` in [0, 1], component-wise in x, y and heading: the correction grows linearly.
inline Pose2 pose_between(const Anchor& earlier, const Anchor& later, double ratio,
                          const Pose2& T_odom_base) {
  const Pose2 forward = earlier.carried_to(T_odom_base);
  const Pose2 backward = later.carried_to(T_odom_base);
  return {forward.x_m() + ratio * (backward.x_m() - forward.x_m()),
          forward.y_m() + ratio * (backward.y_m() - forward.y_m()),
          forward.theta_rad() + ratio * wrap_angle(backward.theta_rad() - forward.theta_rad())};
}

}  // namespace corridor::karto
