// The door to rosbag_storage and ROS 1 message headers, compiled as C++17 because those headers are
// no C++20; its types are plain for the same reason. It trusts what it is given: bag_framing checks
// a file before it comes here. Internal to this folder; bag.hpp is the way in.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "slam/core/result.hpp"

namespace corridor::formats::ros1 {

// Stamps are those of the messages' headers. Angles [rad], lengths [m], SI units throughout.
// has_more: the message says something in fields that are not here; zeros say nothing.
struct Scan {
  float angle_min_rad = 0;
  float angle_max_rad = 0;
  float angle_increment_rad = 0;
  float time_increment_s = 0;
  float range_min_m = 0;
  float range_max_m = 0;
  std::vector<float> ranges_m;
  std::vector<float> intensities;
  float scan_time_s = 0;  // from scan to scan
};

struct Odometry {
  double x_m = 0;
  double y_m = 0;
  double qx = 0;
  double qy = 0;
  double qz = 0;
  double qw = 1;
  bool has_more = false;  // twist, covariances, height
};

struct Imu {
  double gyro_z_radps = 0;
  double accel_x_mps2 = 0;
  double accel_y_mps2 = 0;
  // sensor_msgs/Imu: a covariance of -1 says that the quantity is not measured.
  bool has_gyro = true;
  bool has_accel = true;
  bool has_more = false;  // orientation, the other axes, covariances
};

struct Joints {
  std::vector<std::string> names;
  std::vector<double> positions_rad;
  bool has_more = false;  // velocities, efforts
};

struct Message {
  std::string topic;
  std::int64_t record_ns = 0;  // when it was recorded
  std::int64_t stamp_ns = 0;   // of its header
  std::variant<Scan, Odometry, Imu, Joints> content;
};

// Messages of `topics` in the order of their record times; each topic must be of one of the four
// types. An Error if rosbag throws or gives a message of another type.
Result<std::vector<Message>> read_messages(const std::string& path,
                                           const std::vector<std::string>& topics);

enum class Compression { kNone, kBz2, kLz4 };

// Chunks of at least `chunk_bytes`. An Error if rosbag throws.
Result<void> write_messages(const std::string& path, const std::vector<Message>& messages,
                            Compression compression, std::uint32_t chunk_bytes = 768 * 1024);

}  // namespace corridor::formats::ros1
