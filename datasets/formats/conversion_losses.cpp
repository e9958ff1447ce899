// What a log format cannot hold: counted on the log at hand, so that `convert` says only what is
// true.
#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <optional>

#include "datasets/formats/log_io.hpp"
#include "datasets/formats/rawlog/rawlog.hpp"

namespace corridor::formats {
namespace {

// Angles and limits are 32-bit floats in a rawlog; a change below this is not worth a line.
constexpr double kNoticed = 1e-6;

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
      if (std::abs(wrap_angle(turn_rad)) > kNoticed) ++num_turned;
      count_model_differences(*scan);
    }
    note(num_fine_stamps, "stamps are rounded to 100 ns");
    note(num_turned,
         "scans have their LiDAR frame turned so that the fan is symmetric about it; "
         "the beams do not move");
    note(num_other_limits_,
         "scans lose a minimum range or a duration that differs from the robot "
         "model's");
    if (log_.num_scans() > 0) lines_.emplace_back("scan angles are rounded to 32-bit floats");
    return std::move(lines_);
  }

  std::vector<std::string> of_carmen() {
    std::size_t num_ticks = 0;
    std::size_t num_raw_ranges = 0;
    std::size_t num_at_limit = 0;
    std::size_t num_scans_alone = 0;
    std::size_t num_swept = 0;
    std::optional<Timestamp> last_wheels;
    for (const SensorEvent& event : log_.events) {
      if (const auto* sample = std::get_if<WheelSample>(&event)) {
        if (sample->ticks) ++num_ticks;
        last_wheels = sample->stamp;
      }
      const auto* scan = std::get_if<LaserScan>(&event);
      if (scan == nullptr) continue;
      if (last_wheels != scan->stamp) ++num_scans_alone;
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
    note(num_scans_alone, "scans without a wheel sample of their stamp get an interpolated one");
    note(num_swept, "scans lose the time their sweep took");
    lines_.emplace_back("the robot model is left out, but for the LiDAR's pose and range");
    return std::move(lines_);
  }

  std::vector<std::string> of_rosbag() {
    std::size_t num_ticks = 0;
    std::size_t num_raw_ranges = 0;
    std::size_t num_near = 0;
    for (const SensorEvent& event : log_.events) {
      const auto* sample = std::get_if<WheelSample>(&event);
      if (sample != nullptr && sample->ticks) ++num_ticks;
      const auto* scan = std::get_if<LaserScan>(&event);
      if (scan == nullptr) continue;
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
    if (log_.num_scans() > 0) lines_.push_back("scan angles are rounded to 32-bit floats");
    lines_.push_back("the robot model is left out, with the places of LiDAR and IMU");
    return std::move(lines_);
  }

 private:
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
