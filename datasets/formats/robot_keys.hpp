// Which values of a robot model somebody states: the rest are assumed.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <set>
#include <string>
#include <string_view>

#include "slam/core/robot_model.hpp"

namespace corridor::formats {

// Paths of keys as in LOG.robot.toml: "lidar.range_max_m".
using RobotKeys = std::set<std::string, std::less<>>;

inline constexpr std::array<std::string_view, 3> kTickKeys = {
    "wheels.track_m", "wheels.left_m_per_tick", "wheels.right_m_per_tick"};
inline constexpr std::array<std::string_view, 3> kLidarPoseKeys = {"lidar.x_m", "lidar.y_m",
                                                                   "lidar.yaw_deg"};
inline constexpr std::array<std::string_view, 3> kImuPoseKeys = {"imu.x_m", "imu.y_m",
                                                                 "imu.yaw_deg"};

inline bool states(const RobotKeys& keys, std::string_view key) { return keys.count(key) > 0; }

inline bool states_any(const RobotKeys& keys, const auto& paths) {
  return std::any_of(paths.begin(), paths.end(),
                     [&](std::string_view path) { return states(keys, path); });
}

inline bool states_all(const RobotKeys& keys, const auto& paths) {
  return std::all_of(paths.begin(), paths.end(),
                     [&](std::string_view path) { return states(keys, path); });
}

struct StatedRobot {
  RobotModel robot;
  RobotKeys keys;
  // What was lidar.time_offset_s before the reader moved the scans by it.
  double applied_time_offset_s = 0;
};

}  // namespace corridor::formats
