// What a log format cannot hold: counted on the log at hand, so that `convert` says only what is
// true.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "datasets/formats/carmen/carmen.hpp"
#include "datasets/formats/log_io.hpp"
#include "datasets/formats/rawlog/rawlog.hpp"
#include "datasets/formats/robot_toml.hpp"

namespace corridor::formats {
namespace {

// A turn of a frame below this is the rounding of its printed angle.
constexpr double kNoticed_rad = 1e-6;

// Beams of a fan may turn by this and be the same: a tenth of a millimetre at 100 m, a tenth of the
// finest step in which a planar LiDAR tells ranges. A rawlog keeps the whole angle of a fan as a
// 32-bit float, which turns no beam by more than 0.12e-6.
constexpr double kNoticedBeam_rad = 1e-6;
// As little at the last beam of a sweep: a robot at 10 m/s gets a hundredth of a millimetre far.
constexpr double kNoticedSweep_s = 1e-6;

double float_error(double value) {
  return std::abs(static_cast<double>(static_cast<float>(value)) - value);
}

double num_steps_of(const LaserScan& scan) {
  return static_cast<double>(scan.num_beams() < 2 ? 0 : scan.num_beams() - 1);
}

// A bag keeps begin and step of a fan, and the time between beams, as 32-bit floats: how far its
// last beam is off.
double beam_error_in_bag_rad(const LaserScan& scan) {
  return float_error(scan.angle_min_rad) +
         num_steps_of(scan) * float_error(scan.angle_increment_rad);
}

double sweep_error_in_bag_s(const LaserScan& scan) {
  const double num_steps = num_steps_of(scan);
  if (num_steps == 0) return std::abs(scan.duration_s);
  return num_steps * float_error(scan.duration_s / num_steps);
}

// Whether the model says more than what a reader that is told nothing takes for granted; `kept` is
// what a file of the format says of it.
bool says_more(const RobotModel& robot, const RobotModel& kept) {
  return robot_to_toml(robot) != robot_to_toml(kept);
}

class LossFinder {
 public:
  explicit LossFinder(const SensorLog& log) : log_(log) {}

  std::vector<std::string> of_rawlog() {
    std::size_t num_fine_stamps = 0;
    std::size_t num_turned = 0;
    for (const SensorEvent& event : log_.events) {
      if (stamp_of(event).nanoseconds % kRawlogTick_ns != 0) ++num_fine_stamps;
      const auto* scan = std::get_if<LaserScan>(&event);
      if (scan == nullptr) continue;
      const double turn_rad =
          centred_lidar_pose(*scan).theta_rad() - scan->T_base_lidar.theta_rad();
      if (std::abs(wrap_angle(turn_rad)) > kNoticed_rad) ++num_turned;
      count_model_differences(*scan);
    }
    note(num_fine_stamps, "stamps are rounded to 100 ns");
    note(num_turned,
         "scans have their LiDAR frame turned so that the fan is symmetric about it; "
         "the beams do not move");
    note(num_other_limits_,
         "scans lose a minimum range or a duration that differs from the robot "
         "model's");
    note_reference();
    return std::move(lines_);
  }

  std::vector<std::string> of_carmen() {
    std::size_t num_ticks = 0;
    std::size_t num_raw_ranges = 0;
    std::size_t num_at_limit = 0;
    std::size_t num_swept = 0;
    for (const SensorEvent* event : carmen_events(log_)) {
      const auto* sample = std::get_if<WheelSample>(event);
      if (sample != nullptr && sample->ticks) ++num_ticks;
      const auto* scan = std::get_if<LaserScan>(event);
      if (scan == nullptr) continue;
      if (scan->duration_s != 0) ++num_swept;
      for (std::size_t i = 0; i < scan->num_beams(); ++i) {
        const double range_m = scan->ranges_m[i];
        if (scan->is_valid[i] == 0 && range_m > 0 && range_m < scan->range_max_m) ++num_raw_ranges;
        if (scan->is_valid[i] != 0 && range_m >= scan->range_max_m) ++num_at_limit;
      }
    }
    note(log_.num_imu_samples(), "IMU readings are left out");
    note(num_ticks, "wheel samples lose their encoder ticks");
    note(num_raw_ranges, "beams without return lose their raw range");
    note(num_at_limit, "beams of exactly the maximum range become beams without return");
    note_scans_alone();
    note(num_swept, "scans lose the time their sweep took");
    RobotModel kept;
    kept.lidar.T_base_lidar = log_.robot.lidar.T_base_lidar;
    kept.lidar.range_max_m = log_.robot.lidar.range_max_m;
    kept.lidar.scan_duration_s = log_.robot.lidar.scan_duration_s;  // said above
    const double range_sigma_m = log_.robot.lidar.range_sigma_m;
    if (StatedNoise::is_sensible(range_sigma_m)) kept.lidar.range_sigma_m = range_sigma_m;
    if (says_more(log_.robot, kept)) {
      lines_.emplace_back("the robot model is left out, but for the LiDAR's pose, range and noise");
    }
    note_lidar_clock();
    note_reference();
    return std::move(lines_);
  }

  std::vector<std::string> of_rosbag() {
    std::size_t num_ticks = 0;
    std::size_t num_raw_ranges = 0;
    std::size_t num_near = 0;
    std::size_t num_turned = 0;
    std::size_t num_durations = 0;
    double most_turned_rad = 0;
    double most_late_s = 0;
    for (const SensorEvent& event : log_.events) {
      const auto* sample = std::get_if<WheelSample>(&event);
      if (sample != nullptr && sample->ticks) ++num_ticks;
      const auto* scan = std::get_if<LaserScan>(&event);
      if (scan == nullptr) continue;
      const double turned_rad = beam_error_in_bag_rad(*scan);
      if (turned_rad > kNoticedBeam_rad) ++num_turned;
      most_turned_rad = std::max(most_turned_rad, turned_rad);
      const double late_s = sweep_error_in_bag_s(*scan);
      if (late_s > kNoticedSweep_s) ++num_durations;
      most_late_s = std::max(most_late_s, late_s);
      for (std::size_t i = 0; i < scan->num_beams(); ++i) {
        const double range_m = scan->ranges_m[i];
        const bool looks_valid =
            range_m > 0 && range_m >= scan->range_min_m && range_m <= scan->range_max_m;
        if (scan->is_valid[i] == 0 && looks_valid) ++num_raw_ranges;
        if (scan->is_valid[i] != 0 && !looks_valid) ++num_near;
      }
    }
    note(num_ticks, "wheel samples lose their encoder ticks");
    note(num_raw_ranges, "beams without return lose their raw range");
    note(num_near, "beams below the minimum range become beams without return");
    note(num_turned,
         fmt::format("scans have beams turned by up to {:.1f} microradians: their angles "
                     "become 32-bit floats",
                     1e6 * most_turned_rad));
    note(num_durations,
         fmt::format("scans have the time of their sweep changed by up to {:.1f} us: "
                     "it becomes a 32-bit float",
                     1e6 * most_late_s));
    RobotModel kept;
    kept.lidar.range_min_m = log_.robot.lidar.range_min_m;
    kept.lidar.range_max_m = log_.robot.lidar.range_max_m;
    kept.lidar.scan_duration_s = log_.robot.lidar.scan_duration_s;
    if (says_more(log_.robot, kept)) {
      lines_.emplace_back("the robot model is left out, with the places of LiDAR and IMU");
    }
    note_lidar_clock();
    note_reference();
    return std::move(lines_);
  }

 private:
  // The stamps stay, what they mean is lost.
  void note_lidar_clock() {
    const double offset_s = log_.robot.lidar.time_offset_s;
    if (offset_s == 0) return;
    lines_.push_back(
        fmt::format("the LiDAR's stamps stay {} s ahead of the wheels': to be stated as "
                    "lidar.time_offset_s in the new log's .robot.toml",
                    offset_s));
  }

  // CARMEN's laser lines state a pose, whether the wheels gave one then or not.
  void note_scans_alone() {
    const auto events = carmen_events(log_);
    const auto is_wheels = [](const SensorEvent* event) {
      return std::holds_alternative<WheelSample>(*event);
    };
    const auto first = std::find_if(events.begin(), events.end(), is_wheels);
    const auto last = std::find_if(events.rbegin(), events.rend(), is_wheels);
    if (first == events.end()) return;  // refused
    std::size_t num_between = 0;
    std::size_t num_outside = 0;
    std::optional<Timestamp> wheels;
    for (const SensorEvent* event : events) {
      const Timestamp stamp = stamp_of(*event);
      if (is_wheels(event)) wheels = stamp;
      if (is_wheels(event) || wheels == stamp) continue;
      const bool is_outside = stamp < stamp_of(**first) || stamp > stamp_of(**last);
      ++(is_outside ? num_outside : num_between);
    }
    note(num_between, "scans without a wheel sample of their stamp get an interpolated one");
    note(num_outside, "scans before the first or behind the last wheel sample get its pose");
  }

  void note_reference() {
    if (!log_.truth || !log_.provenance.is_truth_reference) return;
    note(log_.truth->size(),
         "poses that another program found are no truth: they go to LOG.reference.tum");
  }

  void note(std::size_t count, const std::string& what) {
    if (count > 0) lines_.push_back(fmt::format("{} {}", count, what));
  }

  void count_model_differences(const LaserScan& scan) {
    if (scan.range_min_m != log_.robot.lidar.range_min_m ||
        scan.duration_s != log_.robot.lidar.scan_duration_s) {
      ++num_other_limits_;
    }
  }

  const SensorLog& log_;
  std::size_t num_other_limits_ = 0;
  std::vector<std::string> lines_;
};

}  // namespace

std::vector<std::string> losses_of_conversion(const SensorLog& log, LogFormat target) {
  LossFinder finder(log);
  switch (target) {
    case LogFormat::kRawlog:
      return finder.of_rawlog();
    case LogFormat::kCarmen:
      return finder.of_carmen();
    case LogFormat::kRosbag:
      return finder.of_rosbag();
    case LogFormat::kLcm:
    case LogFormat::kTicks:
      return {};  // nothing is written in these formats
  }
  return {};
}

}  // namespace corridor::formats
