#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "datasets/formats/carmen/carmen.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

std::string pose_text(const Pose2& pose) {
  return fmt::format("{} {} {}", pose.x_m(), pose.y_m(), pose.theta_rad());
}

std::string stamp_text(Timestamp stamp) {
  const std::string text = format_stamp(stamp);
  return fmt::format("{} {} {}", text, kCarmenHost, text);
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

std::string speed_text(const CarmenSpeed& speed) {
  return fmt::format("{} {}", speed.forward_mps, speed.turn_radps);
}

// What each line says of the wheels.
std::vector<WheelSample> wheel_lines(const Events& events) {
  std::vector<WheelSample> lines;
  lines.reserve(events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    const auto* sample = std::get_if<WheelSample>(events[i]);
    lines.push_back(sample != nullptr
                        ? *sample
                        : WheelSample{stamp_of(*events[i]), odometry_at(events, i), std::nullopt});
  }
  return lines;
}

// The speed since the wheels of another stamp; nullopt where the step tells none.
std::optional<CarmenSpeed> speed_between(const WheelSample& before, const WheelSample& after) {
  const double step_s = seconds_between(before.stamp, after.stamp);
  if (step_s <= 0) return std::nullopt;
  const Pose2::Tangent velocity = after.T_odom_base.minus(before.T_odom_base) / step_s;
  const LogLimits limits;
  const bool is_possible = std::abs(velocity.x()) <= limits.max_speed_mps &&
                           std::abs(velocity.z()) <= limits.max_yaw_rate_radps;
  if (!is_possible) return std::nullopt;
  return CarmenSpeed{velocity.x(), velocity.z()};
}

std::string scan_line(const LaserScan& scan, const Pose2& T_odom_base, const CarmenSpeed& speed,
                      double range_sigma_m) {
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
  return line + fmt::format(" 0 {} {} {} 0 0 0 {}\n", pose_text(T_odom_base * scan.T_base_lidar),
                            pose_text(T_odom_base), speed_text(speed), stamp_text(scan.stamp));
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

std::vector<CarmenSpeed> carmen_speeds(const std::vector<WheelSample>& lines) {
  std::vector<CarmenSpeed> speeds;
  speeds.reserve(lines.size());
  const auto starts_new_stamp = [&lines](std::size_t i) {
    return i > 0 && lines[i].stamp != lines[i - 1].stamp;
  };
  std::size_t second = 0;
  while (second < lines.size() && !starts_new_stamp(second)) ++second;
  CarmenSpeed speed;
  if (second < lines.size()) {
    speed = speed_between(lines[second - 1], lines[second]).value_or(speed);
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (starts_new_stamp(i)) speed = speed_between(lines[i - 1], lines[i]).value_or(speed);
    speeds.push_back(speed);
  }
  return speeds;
}

std::string carmen_text(const SensorLog& log) {
  std::string text =
      "# CARMEN log; ROBOTLASER1 poses are raw wheel odometry, tv and rv follow from it\n";
  const Events events = carmen_events(log);
  const std::vector<WheelSample> lines = wheel_lines(events);
  const std::vector<CarmenSpeed> speeds = carmen_speeds(lines);
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (const auto* scan = std::get_if<LaserScan>(events[i])) {
      text += scan_line(*scan, lines[i].T_odom_base, speeds[i], log.robot.lidar.range_sigma_m);
    } else {
      text += fmt::format("ODOM {} {} 0 {}\n", pose_text(lines[i].T_odom_base),
                          speed_text(speeds[i]), stamp_text(lines[i].stamp));
    }
  }
  return text;
}

}  // namespace corridor::formats
