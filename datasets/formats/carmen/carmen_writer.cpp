#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "datasets/formats/carmen/carmen.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

constexpr const char* kHost = "corridor-bench";

std::string pose_text(const Pose2& pose) {
  return fmt::format("{} {} {}", pose.x_m(), pose.y_m(), pose.theta_rad());
}

std::string stamp_text(Timestamp stamp) {
  const std::string text = format_stamp(stamp);
  return fmt::format("{} {} {}", text, kHost, text);
}

using Events = std::vector<const SensorEvent*>;

const WheelSample* wheels_before(const Events& events, std::size_t index) {
  while (index-- > 0) {
    if (const auto* sample = std::get_if<WheelSample>(events[index])) return sample;
  }
  return nullptr;
}

const WheelSample* wheels_after(const Events& events, std::size_t index) {
  for (++index; index < events.size(); ++index) {
    if (const auto* sample = std::get_if<WheelSample>(events[index])) return sample;
  }
  return nullptr;
}

// The wheels' pose at a scan, on the geodesic between the samples around it; the nearest at the
// ends.
Pose2 odometry_at(const Events& events, std::size_t scan_index) {
  const Timestamp stamp = stamp_of(*events[scan_index]);
  const WheelSample* before = wheels_before(events, scan_index);
  const WheelSample* after = wheels_after(events, scan_index);
  if (before == nullptr) return after->T_odom_base;
  if (after == nullptr || before->stamp == stamp) return before->T_odom_base;
  const double ratio =
      seconds_between(before->stamp, stamp) / seconds_between(before->stamp, after->stamp);
  const Pose2::Tangent step = after->T_odom_base.minus(before->T_odom_base);
  return before->T_odom_base.plus(ratio * step);
}

std::string scan_line(const LaserScan& scan, const Pose2& T_odom_base, double range_sigma_m) {
  const double field_of_view_rad =
      scan.angle_increment_rad *
      static_cast<double>(scan.num_beams() > 0 ? scan.num_beams() - 1 : 0);
  std::string line =
      fmt::format("ROBOTLASER1 0 {} {} {} {} {} 0 {}", scan.angle_min_rad, field_of_view_rad,
                  scan.angle_increment_rad, scan.range_max_m, range_sigma_m, scan.num_beams());
  for (std::size_t i = 0; i < scan.num_beams(); ++i) {
    // CARMEN tells a return from none by the range alone.
    const bool looks_valid = scan.ranges_m[i] > 0 && scan.ranges_m[i] < scan.range_max_m;
    line += looks_valid && scan.is_valid[i] == 0 ? " 0" : fmt::format(" {}", scan.ranges_m[i]);
  }
  return line + fmt::format(" 0 {} {} 0 0 0 0 0 {}\n", pose_text(T_odom_base * scan.T_base_lidar),
                            pose_text(T_odom_base), stamp_text(scan.stamp));
}

}  // namespace

std::vector<const SensorEvent*> carmen_events(const SensorLog& log) {
  Events events;
  for (const SensorEvent& event : log.events) {
    if (!std::holds_alternative<ImuSample>(event)) events.push_back(&event);
  }
  std::stable_sort(events.begin(), events.end(), [](const SensorEvent* a, const SensorEvent* b) {
    const auto key = [](const SensorEvent* event) {
      return std::pair(stamp_of(*event), std::holds_alternative<LaserScan>(*event));
    };
    return key(a) < key(b);
  });
  return events;
}

std::string carmen_text(const SensorLog& log) {
  std::string text = "# CARMEN log; ROBOTLASER1 poses are raw wheel odometry\n";
  const Events events = carmen_events(log);
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (const auto* scan = std::get_if<LaserScan>(events[i])) {
      text += scan_line(*scan, odometry_at(events, i), log.robot.lidar.range_sigma_m);
    } else if (const auto* sample = std::get_if<WheelSample>(events[i])) {
      text += fmt::format("ODOM {} 0 0 0 {}\n", pose_text(sample->T_odom_base),
                          stamp_text(sample->stamp));
    }
  }
  return text;
}

}  // namespace corridor::formats
