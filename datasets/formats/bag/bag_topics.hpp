// Which topics of a ROS 1 bag are which sensor: LOG.topics.toml beside the bag, or `topics` in the
// catalogue.
//   [topics]
//   scan = "/scan"          # sensor_msgs/LaserScan
//   odometry = "/odom"      # nav_msgs/Odometry
//   imu = "/imu/data"       # sensor_msgs/Imu
//   joints = "/joints"      # sensor_msgs/JointState: wheel angles instead of odometry
//   [joints]
//   left = "wheel_left"     # names of the joints
//   right = "wheel_right"
//   ticks_per_turn = 4096   # the resolution that angles are turned into ticks with
// A topic that is not named is the only one of its type in the bag; "" leaves the sensor out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "slam/core/result.hpp"

namespace corridor::formats {

struct WheelJoints {
  std::string topic;
  std::string left;
  std::string right;
  std::int64_t ticks_per_turn = 0;
};

struct BagTopics {
  std::optional<std::string> scan;
  std::optional<std::string> odometry;
  std::optional<std::string> imu;
  std::optional<WheelJoints> joints;  // only if named: they stand in for the odometry
};

// The Error lists every violation with its line: unknown keys, values that are no text, joints
// without names or ticks, joints together with odometry.
Result<BagTopics> bag_topics_from_toml(std::string_view text, const std::string& where);

}  // namespace corridor::formats
