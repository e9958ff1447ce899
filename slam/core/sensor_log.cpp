#include "slam/core/sensor_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "slam/core/same_reading.hpp"

namespace corridor {
namespace {

template <class T>
std::size_t count_of(const std::vector<SensorEvent>& events) {
  return static_cast<std::size_t>(
      std::count_if(events.begin(), events.end(),
                    [](const SensorEvent& e) { return std::holds_alternative<T>(e); }));
}

const char* name_of(const SensorEvent& event) {
  constexpr const char* kNames[] = {"scan", "wheel sample", "IMU sample"};
  return kNames[event.index()];
}

std::optional<std::string> defect(const LaserScan& scan) {
  if (scan.num_beams() == 0 || scan.is_valid.size() != scan.num_beams()) {
    return fmt::format("scan with {} ranges and {} validities; expected as many, not 0",
                       scan.num_beams(), scan.is_valid.size());
  }
  if (!std::isfinite(scan.angle_min_rad) || !std::isfinite(scan.angle_increment_rad) ||
      !scan.T_base_lidar.is_finite() || !std::isfinite(scan.range_max_m) ||
      !std::isfinite(scan.duration_s)) {
    return "scan geometry or duration is not finite; expected finite numbers";
  }
  for (std::size_t i = 0; i < scan.num_beams(); ++i) {
    if (!scan.is_valid[i]) continue;
    const double range_m = scan.ranges_m[i];
    if (!(range_m > 0 && range_m <= scan.range_max_m)) {
      return fmt::format("beam {} is marked valid with range {} m; expected (0, {}] m", i, range_m,
                         scan.range_max_m);
    }
  }
  return std::nullopt;
}

std::optional<std::string> defect(const WheelSample& sample) {
  if (sample.T_odom_base.is_finite()) return std::nullopt;
  return "odometry pose is not finite; expected finite numbers";
}

std::optional<std::string> defect(const ImuSample& sample) {
  if (std::isfinite(sample.gyro_z_radps) && std::isfinite(sample.accel_x_mps2) &&
      std::isfinite(sample.accel_y_mps2)) {
    return std::nullopt;
  }
  return "IMU reading is not finite; expected finite numbers";
}

class DefectFinder {
 public:
  DefectFinder(const std::vector<SensorEvent>& events, const LogLimits& limits,
               std::size_t max_lines)
      : events_(events), limits_(limits), max_lines_(max_lines) {}

  void add(std::string line) {
    if (found_.size() < max_lines_) found_.push_back(std::move(line));
  }

  void visit(std::size_t index, const SensorEvent& event) {
    check_order(index, event);
    first_of_sensor_.try_emplace(event.index(), Place{index, stamp_of(event)});
    last_place_of_sensor_[event.index()] = {index, stamp_of(event)};
    if (const auto what = defect_of(event)) {
      add(fmt::format("event {}: {}", index, *what));
    } else {
      std::visit([&](const auto& reading) { check(index, reading); }, event);
    }
  }

  // What is left of the wheels after the last full window; of a short log, all of it. In so short a
  // time a clock that jitters may make up a jump or a part of a window, but no more.
  void check_rest() {
    if (window_.duration_s <= 0) return;
    const double longest_m = limits_.max_speed_mps * window_.duration_s + limits_.max_jump_m;
    if (window_.path_m > longest_m && !window_.has_jump) add_speed(last_wheel_index_);
    if (window_.turn_rad > limits_.max_yaw_rate_radps * limits_.speed_window_s) {
      add_yaw_rate(last_wheel_index_);
    }
  }

  // A sensor that begins long after the log or ends long before it is a log cut or badly joined.
  void check_span() {
    const Timestamp begin = stamp_of(events_.front());
    const Timestamp end = stamp_of(events_.back());
    for (const auto& [sensor, first] : first_of_sensor_) {
      const Place& last = last_place_of_sensor_.at(sensor);
      const double late_s = seconds_between(begin, first.stamp);
      const double early_s = seconds_between(last.stamp, end);
      const char* name = name_of(events_[first.event_index]);
      if (late_s > limits_.max_gap_s) {
        add(
            fmt::format("event {}: the first {} comes {:.3f} s after the log's first reading; "
                        "expected at most {} s",
                        first.event_index, name, late_s, limits_.max_gap_s));
      }
      if (early_s > limits_.max_gap_s) {
        add(
            fmt::format("event {}: the last {} comes {:.3f} s before the log's end; expected at "
                        "most {} s",
                        last.event_index, name, early_s, limits_.max_gap_s));
      }
    }
  }

  std::vector<std::string> take() { return std::move(found_); }

 private:
  struct Place {
    std::size_t event_index = 0;
    Timestamp stamp;
  };

  // Of the wheels, since the last window was full.
  struct Window {
    double duration_s = 0;
    double path_m = 0;
    double turn_rad = 0;
    bool has_jump = false;  // said already
  };

  void check_order(std::size_t index, const SensorEvent& event) {
    const Timestamp stamp = stamp_of(event);
    if (last_stamp_ && stamp < *last_stamp_) {
      add(fmt::format("event {}: stamp steps back by {:.6f} s; expected stamps in order", index,
                      seconds_between(stamp, *last_stamp_)));
    }
    last_stamp_ = stamp;
    auto& last_of_sensor = last_of_sensor_[event.index()];
    if (last_of_sensor) {
      const double step_s = seconds_between(*last_of_sensor, stamp);
      if (step_s == 0) {
        const SensorEvent& before = events_[last_place_of_sensor_.at(event.index()).event_index];
        const std::string_view other = difference_of(before, event);
        add(fmt::format(
            "event {}: {} repeats the stamp of the one before{}{}; expected a later one", index,
            name_of(event), other.empty() ? "" : ", which has ", other));
      } else if (step_s > limits_.max_gap_s) {
        add(fmt::format("event {}: gap of {:.3f} s between two {}s; expected at most {} s", index,
                        step_s, name_of(event), limits_.max_gap_s));
      }
    }
    last_of_sensor = stamp;
  }

  void check(std::size_t index, const LaserScan& scan) {
    if (num_beams_ && scan.num_beams() != *num_beams_) {
      add(fmt::format("event {}: scan of {} beams; expected {} as before", index, scan.num_beams(),
                      *num_beams_));
    }
    num_beams_ = scan.num_beams();
  }

  void check(std::size_t index, const WheelSample& sample) {
    if (last_wheel_) {
      const double step_s = seconds_between(last_wheel_->stamp, sample.stamp);
      const Pose2 step = last_wheel_->T_odom_base.between(sample.T_odom_base);
      if (step_s > 0) check_step(index, step_s, step);
    }
    last_wheel_ = sample;
    last_wheel_index_ = index;
  }

  void check_step(std::size_t index, double step_s, const Pose2& step) {
    const double length_m = step.translation_m().norm();
    if (!(length_m <= limits_.max_speed_mps * step_s + limits_.max_jump_m)) {
      add(fmt::format("event {}: odometry moves {:.3f} m in {:.4f} s; expected at most {} m/s",
                      index, length_m, step_s, limits_.max_speed_mps));
      window_.has_jump = true;
    }
    window_.duration_s += step_s;
    window_.path_m += length_m;
    window_.turn_rad += std::abs(step.theta_rad());
    if (window_.duration_s < limits_.speed_window_s) return;
    check_window(index);
    window_ = {};
  }

  void check_window(std::size_t index) {
    const double speed_mps = window_.path_m / window_.duration_s;
    const double yaw_rate_radps = window_.turn_rad / window_.duration_s;
    if (speed_mps > limits_.max_speed_mps && !window_.has_jump) add_speed(index);
    if (yaw_rate_radps > limits_.max_yaw_rate_radps) add_yaw_rate(index);
  }

  void add_speed(std::size_t index) {
    add(fmt::format("event {}: odometry moves {:.3f} m in {:.4f} s; expected at most {} m/s", index,
                    window_.path_m, window_.duration_s, limits_.max_speed_mps));
  }

  void add_yaw_rate(std::size_t index) {
    add(fmt::format(
        "event {}: odometry turns {:.3f} rad in {:.4f} s; expected at most {} rad/s (degrees?)",
        index, window_.turn_rad, window_.duration_s, limits_.max_yaw_rate_radps));
  }

  void check(std::size_t index, const ImuSample& sample) {
    if (std::abs(sample.gyro_z_radps) > limits_.max_yaw_rate_radps) {
      add(fmt::format("event {}: yaw rate {:.3f} rad/s; expected at most {} (degrees per second?)",
                      index, sample.gyro_z_radps, limits_.max_yaw_rate_radps));
    }
    const double acceleration_mps2 = std::hypot(sample.accel_x_mps2, sample.accel_y_mps2);
    if (acceleration_mps2 > limits_.max_acceleration_mps2) {
      add(fmt::format("event {}: acceleration {:.3f} m/s2; expected at most {} (raw counts?)",
                      index, acceleration_mps2, limits_.max_acceleration_mps2));
    }
  }

  const std::vector<SensorEvent>& events_;
  const LogLimits& limits_;
  std::size_t max_lines_;
  std::vector<std::string> found_;
  std::optional<Timestamp> last_stamp_;
  std::map<std::size_t, std::optional<Timestamp>> last_of_sensor_;
  std::optional<std::size_t> num_beams_;
  std::map<std::size_t, Place> first_of_sensor_;
  std::map<std::size_t, Place> last_place_of_sensor_;
  std::optional<WheelSample> last_wheel_;
  std::size_t last_wheel_index_ = 0;
  Window window_;
};

}  // namespace

Timestamp stamp_of(const SensorEvent& event) {
  return std::visit([](const auto& reading) { return reading.stamp; }, event);
}

std::optional<std::string> defect_of(const SensorEvent& event) {
  return std::visit([](const auto& reading) { return defect(reading); }, event);
}

std::size_t SensorLog::num_scans() const { return count_of<LaserScan>(events); }
std::size_t SensorLog::num_wheel_samples() const { return count_of<WheelSample>(events); }
std::size_t SensorLog::num_imu_samples() const { return count_of<ImuSample>(events); }

double SensorLog::duration_s() const {
  return events.size() < 2 ? 0.0
                           : seconds_between(stamp_of(events.front()), stamp_of(events.back()));
}

std::vector<std::string> defects(const SensorLog& log, const LogLimits& limits,
                                 std::size_t max_lines) {
  DefectFinder finder(log.events, limits, max_lines);
  for (std::string& line : violations(log.robot)) finder.add("robot model: " + line);
  if (log.events.empty()) finder.add("the log has no events; expected at least one scan");
  if (!log.events.empty() && log.num_scans() == 0) {
    finder.add("the log has no LiDAR scan; expected at least one");
  }
  for (std::size_t i = 0; i < log.events.size(); ++i) finder.visit(i, log.events[i]);
  if (!log.events.empty()) {
    finder.check_rest();
    finder.check_span();
  }
  return finder.take();
}

}  // namespace corridor
