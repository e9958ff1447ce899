#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/bag/bag.hpp"
#include "datasets/formats/bag/rosbag_door.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

constexpr std::int64_t kEndOfRosTime_ns = (std::int64_t{1} << 32) * 1'000'000'000;

ros1::Scan ros_scan(const LaserScan& scan) {
  ros1::Scan written;
  const auto num_steps = static_cast<double>(std::max<std::size_t>(scan.num_beams(), 2) - 1);
  const double angle_max_rad =
      scan.num_beams() < 2 ? scan.angle_min_rad : scan.angle_rad(scan.num_beams() - 1);
  written.angle_min_rad = static_cast<float>(scan.angle_min_rad);
  written.angle_max_rad = static_cast<float>(angle_max_rad);
  written.angle_increment_rad = static_cast<float>(scan.angle_increment_rad);
  written.time_increment_s = static_cast<float>(scan.duration_s / num_steps);
  written.range_min_m = static_cast<float>(scan.range_min_m);
  written.range_max_m = static_cast<float>(scan.range_max_m);
  written.ranges_m = scan.ranges_m;
  for (std::size_t i = 0; i < scan.num_beams(); ++i) {
    // ROS tells a return from none by the range alone.
    const bool looks_valid = scan.ranges_m[i] > 0 && scan.ranges_m[i] >= written.range_min_m &&
                             scan.ranges_m[i] <= written.range_max_m;
    if (scan.is_valid[i] == 0 && looks_valid) {
      written.ranges_m[i] = std::numeric_limits<float>::infinity();
    }
  }
  return written;
}

ros1::Odometry ros_odometry(const WheelSample& sample) {
  const double half_rad = 0.5 * sample.T_odom_base.theta_rad();
  return {sample.T_odom_base.x_m(), sample.T_odom_base.y_m(), 0, 0,
          std::sin(half_rad),       std::cos(half_rad)};
}

struct EventWriter {
  ros1::Message operator()(const LaserScan& scan) const {
    return {"/scan", 0, scan.stamp.nanoseconds, ros_scan(scan)};
  }
  ros1::Message operator()(const WheelSample& sample) const {
    return {"/odom", 0, sample.stamp.nanoseconds, ros_odometry(sample)};
  }
  ros1::Message operator()(const ImuSample& sample) const {
    return {"/imu", 0, sample.stamp.nanoseconds,
            ros1::Imu{sample.gyro_z_radps, sample.accel_x_mps2, sample.accel_y_mps2}};
  }
};

}  // namespace

Result<std::vector<ros1::Message>> ros_messages(const SensorLog& log, const std::string& where) {
  std::vector<ros1::Message> messages;
  messages.reserve(log.events.size());
  for (const SensorEvent& event : log.events) {
    const Timestamp stamp = stamp_of(event);
    if (stamp.nanoseconds < 0 || stamp.nanoseconds >= kEndOfRosTime_ns) {
      return fail(ErrorCode::kUnsupported, "stamp " + format_stamp(stamp), where,
                  "ROS time, 0 to 4294967295.999999999 s");
    }
    messages.push_back(std::visit(EventWriter{}, event));
    // rosbag refuses a time of recording of zero.
    messages.back().record_ns = std::max<std::int64_t>(stamp.nanoseconds, 1);
  }
  return messages;
}

Result<void> write_bag_file(const SensorLog& log, const std::filesystem::path& path) {
  const auto messages = ros_messages(log, path.string());
  if (!messages) return tl::make_unexpected(messages.error());
  return write_file_atomically(path, [&](const std::filesystem::path& temporary) {
    return ros1::write_messages(temporary.string(), *messages, ros1::Compression::kLz4);
  });
}

}  // namespace corridor::formats
