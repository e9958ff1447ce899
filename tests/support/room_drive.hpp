// The log of a short drive once round the room of synthetic_scan.hpp, which any scan matcher must
// track.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "slam/core/sensor_log.hpp"
#include "tests/support/synthetic_scan.hpp"

namespace corridor::testing {

struct RoomDrive {
  int num_scans = 120;
  double range_max_m = 12;
  double range_sigma_m = 0.01;
  double odometry_scale = 1.03;  // wheels report this times the true distance
  std::uint64_t seed = 1;
};

// True pose at a share of the drive: an ellipse of 1.6 x 1.1 m once round, always facing forward.
inline Pose2 room_pose(double share) {
  const double phase = 2 * std::numbers::pi * share;
  return {1.6 * std::cos(phase), 1.1 * std::sin(phase),
          std::atan2(1.1 * std::cos(phase), -1.6 * std::sin(phase))};
}

// Wheel sample and scan at the same stamps, 0.1 s apart; truth with the first pose at the origin.
inline SensorLog room_log(const RoomDrive& drive = {}) {
  SensorLog log;
  log.robot.lidar.range_max_m = drive.range_max_m;
  log.truth.emplace();
  Rng rng = Rng(drive.seed).stream("room");
  const Pose2 T_world_start = room_pose(0);
  Pose2 T_world_last = T_world_start;
  Pose2 T_odom_base;
  for (int i = 0; i < drive.num_scans; ++i) {
    const Timestamp stamp = timestamp_from_seconds(0.1 * i);
    const Pose2 T_world_base = room_pose(static_cast<double>(i) / drive.num_scans);
    const Pose2 motion = T_world_last.between(T_world_base);
    T_odom_base =
        T_odom_base * Pose2(drive.odometry_scale * motion.x_m(), motion.y_m(), motion.theta_rad());
    T_world_last = T_world_base;
    log.events.emplace_back(WheelSample{stamp, T_odom_base, std::nullopt});
    log.events.emplace_back(
        scan_of(room(), T_world_base, drive.range_max_m, drive.range_sigma_m, rng, stamp));
    (void)log.truth->append({stamp, T_world_start.between(T_world_base), std::nullopt});
  }
  return log;
}

}  // namespace corridor::testing
