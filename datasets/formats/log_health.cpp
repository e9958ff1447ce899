#include "datasets/formats/log_health.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "datasets/formats/frozen_scans.hpp"
#include "datasets/formats/log_suspicions.hpp"
#include "datasets/formats/median.hpp"
#include "datasets/formats/truth_health.hpp"

namespace corridor::formats {
namespace {

constexpr double kGapFactor = 5;
constexpr double kFarMedians = 3;  // ranges beyond as many medians may be codes
constexpr double kTurnWindow_s = 1;
constexpr double kChord_m = 0.1;  // well beyond the digits of printed poses, short beside a room
// Of a window: on straight ways unequal wheels drift, and there is no turn to compare.
constexpr double kLeastWindowTurn_rad = 0.05;
constexpr double kLeastTurn_rad = 0.5;

// 0 for nothing; of an even number the upper of the two in the middle.
template <class T>
double median_of(std::vector<T> values) {
  return values.empty() ? 0 : static_cast<double>(upper_median(std::move(values)));
}

// A reading and its index among the events.
template <class T>
struct Placed {
  const T* reading;
  std::size_t index;
};

template <class T>
std::vector<Placed<T>> readings_of(const SensorLog& log) {
  std::vector<Placed<T>> readings;
  for (std::size_t i = 0; i < log.events.size(); ++i) {
    if (const T* reading = std::get_if<T>(&log.events[i])) readings.push_back({reading, i});
  }
  return readings;
}

template <class T>
StampHealth stamps_of(const std::vector<Placed<T>>& readings, const EventPlaces& places) {
  StampHealth health;
  health.num_readings = readings.size();
  if (readings.empty()) return health;
  health.first_s = to_seconds(readings.front().reading->stamp);
  health.last_s = to_seconds(readings.back().reading->stamp);
  std::vector<double> steps_s;
  std::size_t longest = 0;
  for (std::size_t i = 1; i < readings.size(); ++i) {
    const double step_s =
        seconds_between(readings[i - 1].reading->stamp, readings[i].reading->stamp);
    if (step_s > 0) steps_s.push_back(step_s);
    health.num_repeats += step_s == 0 ? 1 : 0;
    health.num_back += step_s < 0 ? 1 : 0;
    if (step_s <= 0 && health.first_bad_at.empty()) {
      health.first_bad_at = places.of(readings[i].index);
    }
    if (step_s > health.longest_gap_s) {
      health.longest_gap_s = step_s;
      longest = readings[i].index;
    }
  }
  if (steps_s.empty()) return health;
  health.longest_gap_at = places.of(longest);
  health.median_step_s = median_of(steps_s);
  health.num_gaps = static_cast<std::size_t>(std::count_if(
      steps_s.begin(), steps_s.end(),
      [&health](double step_s) { return step_s > kGapFactor * health.median_step_s; }));
  return health;
}

void find_shared_range(std::vector<float> valid_m, LidarHealth& health) {
  const auto num_valid = static_cast<double>(valid_m.size());
  const double far_m = kFarMedians * health.median_range_m;
  std::erase_if(valid_m, [far_m](float range_m) { return range_m <= far_m; });
  std::sort(valid_m.begin(), valid_m.end());
  for (auto begin = valid_m.begin(); begin != valid_m.end();) {
    const auto end = std::upper_bound(begin, valid_m.end(), *begin);
    const auto count = static_cast<std::size_t>(end - begin);
    if (count > health.num_most_shared) {
      health.num_most_shared = count;
      health.most_shared_range_m = *begin;
    }
    begin = end;
  }
  health.most_shared_ratio = static_cast<double>(health.num_most_shared) / num_valid;
}

LidarHealth lidar_of(const std::vector<Placed<LaserScan>>& scans, const EventPlaces& places) {
  LidarHealth health;
  const LaserScan& first = *scans.front().reading;
  health.min_beams = first.num_beams();
  health.range_limit_m = first.range_max_m;
  health.field_of_view_rad = first.num_beams() < 2 ? 0
                                                   : std::abs(first.angle_increment_rad) *
                                                         static_cast<double>(first.num_beams() - 1);
  std::vector<float> valid_m;
  std::size_t num_beams = 0;
  for (const auto& [scan, index] : scans) {
    health.min_beams = std::min(health.min_beams, scan->num_beams());
    health.max_beams = std::max(health.max_beams, scan->num_beams());
    num_beams += scan->num_beams();
    for (std::size_t i = 0; i < std::min(scan->num_beams(), scan->is_valid.size()); ++i) {
      const float range_m = scan->ranges_m[i];
      if (scan->is_valid[i] == 0 || !std::isfinite(range_m)) continue;
      valid_m.push_back(range_m);
      if (health.longest_range_at.empty() || range_m > health.max_range_m) {
        health.max_range_m = range_m;
        health.longest_range_at = places.of(index);
      }
    }
  }
  if (num_beams == 0) return health;
  health.invalid_ratio = 1 - static_cast<double>(valid_m.size()) / static_cast<double>(num_beams);
  if (valid_m.empty()) return health;
  health.min_range_m = *std::min_element(valid_m.begin(), valid_m.end());
  health.median_range_m = median_of(valid_m);
  find_shared_range(std::move(valid_m), health);
  return health;
}

// What wheels do in a while: stamps that nearly coincide say nothing about speed.
struct WheelWindow {
  double duration_s = 0;
  double path_m = 0;
  double turn_rad = 0;
};

void take_window(const WheelWindow& window, const std::string& place, WheelHealth& health) {
  const double speed_mps = window.path_m / window.duration_s;
  const double yaw_rate_radps = window.turn_rad / window.duration_s;
  if (!health.max_speed_mps || speed_mps > *health.max_speed_mps) {
    health.max_speed_mps = speed_mps;
    health.max_speed_at = place;
  }
  if (!health.max_yaw_rate_radps || yaw_rate_radps > *health.max_yaw_rate_radps) {
    health.max_yaw_rate_radps = yaw_rate_radps;
    health.max_yaw_rate_at = place;
  }
}

// A chord of a path that rolls points along the mean of the headings at its ends.
void take_chords(const std::vector<Placed<WheelSample>>& samples, WheelHealth& health) {
  double sum_sideways_ratio = 0;
  std::optional<Pose2> begin;
  for (const auto& [sample, index] : samples) {
    const Pose2& end = sample->T_odom_base;
    if (!end.is_finite()) continue;
    if (!begin) begin = end;
    const Pose2 step = begin->between(end);
    const double length_m = step.translation_m().norm();
    if (length_m < kChord_m) continue;
    const double off_rad = std::atan2(step.y_m(), step.x_m()) - 0.5 * step.theta_rad();
    sum_sideways_ratio += std::abs(std::sin(off_rad));
    ++health.num_chords;
    begin = end;
  }
  if (health.num_chords == 0) return;
  health.sideways_ratio = sum_sideways_ratio / static_cast<double>(health.num_chords);
}

WheelHealth wheels_of(const std::vector<Placed<WheelSample>>& samples, const LogLimits& limits,
                      const EventPlaces& places) {
  WheelHealth health;
  health.has_ticks = samples.front().reading->ticks.has_value();
  WheelWindow window;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const WheelSample& last = *samples[i - 1].reading;
    const WheelSample& sample = *samples[i].reading;
    if (!last.T_odom_base.is_finite() || !sample.T_odom_base.is_finite()) continue;
    const Pose2 step = last.T_odom_base.between(sample.T_odom_base);
    const double length_m = step.translation_m().norm();
    health.path_m += length_m;
    health.turn_rad += std::abs(step.theta_rad());
    const double step_s = seconds_between(last.stamp, sample.stamp);
    if (step_s <= 0) continue;
    if (length_m > limits.max_speed_mps * step_s + limits.max_jump_m) ++health.num_jumps;
    window.duration_s += step_s;
    window.path_m += length_m;
    window.turn_rad += std::abs(step.theta_rad());
    if (window.duration_s < limits.speed_window_s) continue;
    take_window(window, places.of(samples[i].index), health);
    window = {};
  }
  // A log shorter than one window is judged as a whole.
  if (!health.max_speed_mps && window.duration_s > 0) {
    take_window(window, places.of(samples.back().index), health);
  }
  take_chords(samples, health);
  return health;
}

// Turns of wheels and gyro over the same windows.
struct Turns {
  double wheels_rad = 0;
  double gyro_rad = 0;
};

// The turn between two wheel samples as both sensors have it: the gyro's last reading holds.
struct TurnStep {
  double duration_s = 0;
  double wheels_rad = 0;
  double gyro_radps = 0;
  bool is_at_rest = false;
};

std::vector<TurnStep> turn_steps(const SensorLog& log) {
  std::vector<TurnStep> steps;
  const ImuSample* imu = nullptr;
  const WheelSample* last = nullptr;
  for (const SensorEvent& event : log.events) {
    if (const auto* reading = std::get_if<ImuSample>(&event)) {
      imu = std::isfinite(reading->gyro_z_radps) ? reading : imu;
    }
    const auto* sample = std::get_if<WheelSample>(&event);
    if (sample == nullptr || !sample->T_odom_base.is_finite()) continue;
    const double duration_s = last == nullptr ? 0 : seconds_between(last->stamp, sample->stamp);
    if (imu != nullptr && duration_s > 0) {
      const Pose2 step = last->T_odom_base.between(sample->T_odom_base);
      steps.push_back({duration_s, step.theta_rad(), imu->gyro_z_radps, step == Pose2()});
    }
    last = sample;
  }
  return steps;
}

// Windows, because a short step's turn is mostly noise; counted in the direction of the wheels.
Turns turns_of(const SensorLog& log) {
  const std::vector<TurnStep> steps = turn_steps(log);
  double bias_radps = 0;
  double rest_s = 0;
  for (const TurnStep& step : steps) {
    if (!step.is_at_rest) continue;
    bias_radps += step.gyro_radps * step.duration_s;
    rest_s += step.duration_s;
  }
  bias_radps = rest_s > 0 ? bias_radps / rest_s : 0;
  Turns turns;
  Turns window;
  double window_s = 0;
  for (const TurnStep& step : steps) {
    window.wheels_rad += step.wheels_rad;
    window.gyro_rad += (step.gyro_radps - bias_radps) * step.duration_s;
    window_s += step.duration_s;
    if (window_s < kTurnWindow_s) continue;
    if (std::abs(window.wheels_rad) >= kLeastWindowTurn_rad) {
      turns.wheels_rad += std::abs(window.wheels_rad);
      turns.gyro_rad += window.wheels_rad < 0 ? -window.gyro_rad : window.gyro_rad;
    }
    window = {};
    window_s = 0;
  }
  return turns;
}

ImuHealth imu_of(const SensorLog& log, const std::vector<Placed<ImuSample>>& samples,
                 const EventPlaces& places) {
  ImuHealth health;
  std::vector<double> accel_x_mps2, accel_y_mps2;
  for (const auto& [sample, index] : samples) {
    if (std::isfinite(sample->accel_x_mps2)) accel_x_mps2.push_back(sample->accel_x_mps2);
    if (std::isfinite(sample->accel_y_mps2)) accel_y_mps2.push_back(sample->accel_y_mps2);
    if (std::abs(sample->gyro_z_radps) > health.max_gyro_radps) {
      health.max_gyro_radps = std::abs(sample->gyro_z_radps);
      health.max_gyro_at = places.of(index);
    }
  }
  health.median_accel_x_mps2 = median_of(std::move(accel_x_mps2));
  health.median_accel_y_mps2 = median_of(std::move(accel_y_mps2));
  const Turns turns = turns_of(log);
  if (turns.wheels_rad >= kLeastTurn_rad) {
    health.wheel_turn_rad = turns.wheels_rad;
    health.gyro_turn_rad = turns.gyro_rad;
  }
  return health;
}

}  // namespace

std::string EventPlaces::of(std::size_t event_index) const {
  return event_index < origins.size() ? fmt::format("{} {}", unit, origins[event_index])
                                      : fmt::format("event {}", event_index);
}

std::string EventPlaces::placed(std::string defect) const {
  constexpr std::string_view kEvent = "event ";
  if (!defect.starts_with(kEvent)) return defect;
  std::size_t index = 0;
  const auto [end, error] =
      std::from_chars(defect.data() + kEvent.size(), defect.data() + defect.size(), index);
  if (error != std::errc() || index >= origins.size()) return defect;
  return of(index) + ", " + defect;
}

LogHealth examine(const SensorLog& log, const EventPlaces& places, const LogLimits& limits,
                  std::size_t max_defects) {
  LogHealth health;
  const auto scans = readings_of<LaserScan>(log);
  const auto wheels = readings_of<WheelSample>(log);
  const auto imu = readings_of<ImuSample>(log);
  health.duration_s = log.duration_s();
  health.lidar_stamps = stamps_of(scans, places);
  health.wheel_stamps = stamps_of(wheels, places);
  health.imu_stamps = stamps_of(imu, places);
  if (!scans.empty()) {
    health.lidar = lidar_of(scans, places);
    const FrozenScans frozen = longest_frozen_scans(log);
    health.lidar->num_frozen_scans = frozen.num_scans;
    health.lidar->frozen_path_m = frozen.moved_m;
    health.lidar->frozen_turn_rad = frozen.turned_rad;
    if (frozen.num_scans > 0) health.lidar->frozen_until = places.of(frozen.last_event_index);
  }
  if (!wheels.empty()) health.wheels = wheels_of(wheels, limits, places);
  if (!imu.empty()) health.imu = imu_of(log, imu, places);
  if (log.truth) health.truth = truth_health_of(log, limits);
  for (std::string& line : defects(log, limits, max_defects)) {
    health.defects.push_back(places.placed(std::move(line)));
  }
  if (health.lidar && health.lidar->longest_range_at.empty()) {
    health.defects.emplace_back("no beam of any scan has a return; expected at least one");
  }
  health.suspicions = suspicions_of(health, log.robot, limits);
  return health;
}

}  // namespace corridor::formats
