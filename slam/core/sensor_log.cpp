#include "slam/core/sensor_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

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
      !scan.T_base_lidar.is_finite() || !std::isfinite(scan.range_max_m)) {
    return "scan geometry is not finite";
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
  return "odometry pose is not finite";
}

std::optional<std::string> defect(const ImuSample& sample) {
  if (std::isfinite(sample.gyro_z_radps) && std::isfinite(sample.accel_x_mps2) &&
      std::isfinite(sample.accel_y_mps2)) {
    return std::nullopt;
  }
  return "IMU reading is not finite";
}

class DefectFinder {
 public:
  DefectFinder(const LogLimits& limits, std::size_t max_lines)
      : limits_(limits), max_lines_(max_lines) {}

  void add(std::string line) {
    if (found_.size() < max_lines_) found_.push_back(std::move(line));
  }

  void visit(std::size_t index, const SensorEvent& event) {
    check_order(index, event);
    if (const auto what = defect_of(event)) {
      add(fmt::format("event {}: {}", index, *what));
    } else {
      std::visit([&](const auto& reading) { check(index, reading); }, event);
    }
  }

  std::vector<std::string> take() { return std::move(found_); }

 private:
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
        add(fmt::format("event {}: {} repeats the stamp of the one before; expected a later one",
                        index, name_of(event)));
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
      if (step_s > 0 && step.translation_m().norm() > limits_.max_speed_mps * step_s + 0.5) {
        add(fmt::format("event {}: odometry moves {:.3f} m in {:.4f} s; expected at most {} m/s",
                        index, step.translation_m().norm(), step_s, limits_.max_speed_mps));
      }
    }
    last_wheel_ = sample;
  }

  void check(std::size_t index, const ImuSample& sample) {
    if (std::abs(sample.gyro_z_radps) > limits_.max_yaw_rate_radps) {
      add(fmt::format("event {}: yaw rate {:.3f} rad/s; expected at most {} (degrees per second?)",
                      index, sample.gyro_z_radps, limits_.max_yaw_rate_radps));
    }
  }

  const LogLimits& limits_;
  std::size_t max_lines_;
  std::vector<std::string> found_;
  std::optional<Timestamp> last_stamp_;
  std::map<std::size_t, std::optional<Timestamp>> last_of_sensor_;
  std::optional<std::size_t> num_beams_;
  std::optional<WheelSample> last_wheel_;
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
  DefectFinder finder(limits, max_lines);
  for (std::string& line : violations(log.robot)) finder.add("robot model: " + line);
  if (log.events.empty()) finder.add("the log has no events; expected at least one scan");
  if (!log.events.empty() && log.num_scans() == 0) {
    finder.add("the log has no LiDAR scan; expected at least one");
  }
  for (std::size_t i = 0; i < log.events.size(); ++i) finder.visit(i, log.events[i]);
  return finder.take();
}

}  // namespace corridor
