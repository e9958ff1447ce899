#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "datasets/formats/clock_line.hpp"
#include "datasets/formats/lcm/lcm.hpp"
#include "datasets/formats/lcm/mbot_log.hpp"
#include "datasets/formats/median.hpp"
#include "datasets/formats/sensor_merge.hpp"
#include "datasets/formats/tick_odometry.hpp"
#include "slam/core/units.hpp"

namespace corridor::formats {
namespace {

constexpr double kMicrosecondsPerSecond = 1e6;
constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;
// Sensors on one clock are logged within milliseconds of each other; more says two clocks.
constexpr std::int64_t kMaxClockDifference_us = 1'000'000;
// A quartz is off by a ten-thousandth; a hundredth is not a clock.
constexpr double kMaxDrift_ratio = 0.01;
// At rest on a level floor z reads 1 g; beyond this the unit or the axis is another.
constexpr double kMaxGravityError_ratio = 0.2;
// A turning LiDAR takes a good part of its turn's beams in each sweep; a scan of a hundred times as
// many directions as beams is a corrupted angle, and memory.
constexpr std::size_t kMaxDirectionsPerBeam = 100;
// Reference poses are of scans: a pose farther outside the scans has a broken stamp.
constexpr std::int64_t kMaxOutside_us = 1'000'000;

std::int64_t stamp_us(const Received<Sweep>& sweep) { return sweep.message.times_us.back(); }
template <class T>
std::int64_t stamp_us(const Received<T>& received) {
  return received.message.stamp_us;
}

// Median of received minus stamp: what lies between a sensor's clock and the logger's.
template <class T>
std::int64_t median_delay_us(const std::vector<Received<T>>& list) {
  std::vector<std::int64_t> delays_us;
  delays_us.reserve(list.size());
  for (const auto& received : list) delays_us.push_back(received.utime_us - stamp_us(received));
  return upper_median(std::move(delays_us));
}

std::size_t median_num_beams(const std::vector<Sweep>& sweeps) {
  std::vector<std::size_t> counts;
  for (const Sweep& sweep : sweeps) counts.push_back(sweep.ranges_m.size());
  return upper_median(std::move(counts));
}

class LcmAssembler {
 public:
  LcmAssembler(MbotLog messages, const std::string& file, const LcmOptions& options)
      : in_(std::move(messages)), file_(file), options_(options), wheels_(options.robot.wheels) {
    out_.origin_unit = "byte";
    out_.scans_state_pose = false;
    out_.scans_state_range_max = false;
    out_.scans_state_duration = true;
    out_.is_time_offset_applied = true;
    out_.counts = std::move(in_.counts);
    out_.left_out = std::move(in_.left_out);
  }

  Result<ParsedLog> run() {
    if (auto added = settle_clock(in_.ticks, "wheels"); !added) return failed(added);
    if (auto added = settle_clock(in_.imu, "IMU"); !added) return failed(added);
    if (auto sound = check_gravity(); !sound) return failed(sound);
    if (auto added = add_wheels(); !added) return failed(added);
    add_imu();
    if (auto added = add_scans(); !added) return failed(added);
    add_reference();
    if (const std::size_t num_moved = merge_sensors(out_); num_moved > 0) {
      out_.counts["readings put before one of another sensor that arrived earlier"] = num_moved;
    }
    return std::move(out_);
  }

 private:
  static tl::unexpected<Error> failed(const Result<void>& result) {
    return tl::make_unexpected(result.error());
  }

  [[nodiscard]] tl::unexpected<Error> failure(std::size_t begin, std::string what,
                                              std::string expected) const {
    return fail(ErrorCode::kInvalid, std::move(what), fmt::format("{}: byte {}", file_, begin),
                std::move(expected));
  }

  // Stamps of wheels or IMU onto the LiDAR's clock, by the rule that was stated.
  template <class T>
  Result<void> settle_clock(std::vector<Received<T>>& list, const std::string& sensor) {
    if (list.empty() || in_.sweeps.empty()) return {};
    if (options_.raw.clock == RawClock::kEventOffset) return move_clock(list, sensor);
    const std::int64_t apart_us = median_delay_us(list) - median_delay_us(in_.sweeps);
    if (std::abs(apart_us) <= kMaxClockDifference_us) return {};
    return failure(list.front().begin,
                   fmt::format("the clock of the {} is {:.3f} s behind the LiDAR's", sensor,
                               static_cast<double>(apart_us) / kMicrosecondsPerSecond),
                   "one clock, or raw.clock = \"event-offset\" in the calibration");
  }

  template <class T>
  Result<void> move_clock(std::vector<Received<T>>& list, const std::string& sensor) {
    const std::int64_t lidar_delay_us = median_delay_us(in_.sweeps);
    if (std::abs(lidar_delay_us) > kMaxClockDifference_us) {
      return failure(in_.sweeps.front().begin,
                     fmt::format("the LiDAR's clock is {:.3f} s behind the logger's",
                                 static_cast<double>(lidar_delay_us) / kMicrosecondsPerSecond),
                     "the logger's clock, for raw.clock = \"event-offset\"");
    }
    std::vector<ClockPair> pairs;
    for (const auto& received : list) {
      if (!pairs.empty() && received.message.stamp_us <= pairs.back().stamp_us) {
        return failure(received.begin, fmt::format("stamp of the {} does not increase", sensor),
                       "a later one than before");
      }
      pairs.push_back({received.message.stamp_us, received.utime_us});
    }
    const auto line = clock_line(pairs);
    if (!line || std::abs(line->drift_ratio) > kMaxDrift_ratio) {
      return failure(list.front().begin,
                     fmt::format("the events' times tell no clock of the {}", sensor),
                     fmt::format("two messages or more, clocks that differ by {} s/s at most",
                                 kMaxDrift_ratio));
    }
    for (auto& received : list) {
      received.message.stamp_us = line->to_logger_us(received.message.stamp_us);
    }
    out_.notes.push_back(fmt::format(
        "stamps of the {} moved onto the LiDAR's clock by the events' times: {:.6f} s and {:.1f} "
        "us/s",
        sensor, line->offset_us / kMicrosecondsPerSecond,
        line->drift_ratio * kMicrosecondsPerSecond));
    return {};
  }

  // The median, because a robot may be lifted and shaken.
  [[nodiscard]] Result<void> check_gravity() const {
    if (in_.imu.empty()) return {};
    std::vector<double> z_g;
    for (const auto& imu : in_.imu) {
      z_g.push_back(imu.message.accel_lsb[2] / options_.raw.accel_lsb_per_g);
    }
    const double median_g = upper_median(std::move(z_g));
    if (std::abs(median_g - 1) <= kMaxGravityError_ratio) return {};
    return failure(in_.imu.front().begin,
                   fmt::format("the accelerometer's z reads {:.3f} g at the median", median_g),
                   "1 g within 20 % (z upward, raw.accel_lsb_per_g)");
  }

  Result<void> add_wheels() {
    for (const auto& [ticks, utime_us, begin] : in_.ticks) {
      const Timestamp stamp{ticks.stamp_us * kNanosecondsPerMicrosecond};
      const auto sample =
          wheels_.take(stamp, {ticks.left, ticks.right}, fmt::format("{}: byte {}", file_, begin));
      if (!sample) return tl::make_unexpected(sample.error());
      out_.add(*sample, begin);
    }
    return {};
  }

  void add_imu() {
    const double mps2_per_lsb = kGravity_mps2 / options_.raw.accel_lsb_per_g;
    const double radps_per_lsb = kRadPerDeg / options_.raw.gyro_lsb_per_dps;
    for (const auto& [imu, utime_us, begin] : in_.imu) {
      out_.add(ImuSample{Timestamp{imu.stamp_us * kNanosecondsPerMicrosecond},
                         imu.gyro_lsb[2] * radps_per_lsb, imu.accel_lsb[0] * mps2_per_lsb,
                         imu.accel_lsb[1] * mps2_per_lsb},
               begin);
    }
  }

  Result<void> add_scans() {
    if (in_.sweeps.empty()) return {};
    std::vector<Sweep> sweeps;
    for (const auto& received : in_.sweeps) sweeps.push_back(received.message);
    const FanShape shape = fan_shape(sweeps, options_.raw.is_lidar_clockwise);
    const std::size_t max_beams =
        std::min(kMaxBeams, kMaxDirectionsPerBeam * median_num_beams(sweeps));
    if (shape.num_beams < 2 || shape.num_beams > max_beams) {
      return failure(in_.sweeps.front().begin, "the beams' angles tell no step", "a turning LiDAR");
    }
    const double range_max_m = options_.robot.lidar.range_max_m;
    std::size_t num_returns = 0;
    std::size_t num_beyond = 0;
    FanLosses losses;
    for (const auto& [sweep, utime_us, begin] : in_.sweeps) {
      for (const double range_m : sweep.ranges_m) {
        num_returns += range_m > 0 ? 1 : 0;
        if (range_m <= range_max_m) continue;
        ++num_beyond;
        count_no_return(range_m, range_max_m, out_.counts);
      }
      LaserScan scan = uniform_fan(sweep, shape, range_max_m, losses);
      scan.stamp = add_seconds(scan.stamp, -options_.robot.lidar.time_offset_s);
      out_.add(std::move(scan), begin);
    }
    note_fan(shape, losses);
    if (2 * losses.num_beyond_seam > losses.num_beams) {
      return failure(
          in_.sweeps.front().begin,
          fmt::format("{} of {} beams lie half a turn or more from where they were taken",
                      losses.num_beyond_seam, losses.num_beams),
          "sweeps of a whole turn each");
    }
    if (2 * num_beyond <= num_returns) return {};
    return failure(
        in_.sweeps.front().begin,
        fmt::format("{} of {} ranges lie beyond {} m", num_beyond, num_returns, range_max_m),
        "ranges in metres, or another lidar.range_max_m");
  }

  void note_fan(const FanShape& shape, const FanLosses& losses) {
    const auto count = [](Counts& counts, const char* what, std::size_t number) {
      if (number > 0) counts[what] = number;
    };
    count(out_.left_out,
          "returns left out that share a direction of the uniform fan with a nearer one",
          losses.num_shared_returns);
    count(out_.left_out,
          "beams without return left out that share a direction of the uniform fan with another",
          losses.num_shared);
    count(out_.left_out, "beams left out that point across the sweep's seam",
          losses.num_beyond_seam);
    count(out_.counts, "directions of the uniform fan without a beam taken as no return",
          losses.num_without_beam);
    count(out_.counts, "beams moved by more than 5 ms from the moment they were taken",
          losses.num_late);
    const auto num_returns = static_cast<double>(std::max<std::size_t>(losses.num_returns, 1));
    out_.notes.push_back(fmt::format(
        "{} beams with angles of their own put into a uniform fan of {}: returns turned by {:.2f} "
        "deg (root mean square), at most {:.2f} deg",
        losses.num_beams, shape.num_beams,
        std::sqrt(losses.sum_moved_rad2 / num_returns) / kRadPerDeg,
        losses.max_moved_rad / kRadPerDeg));
  }

  // Poses that the robot's own SLAM gave, with the stamps of the scans they were found with.
  void add_reference() {
    if (in_.poses.empty() || in_.sweeps.empty()) return;
    const std::int64_t begin_us = in_.sweeps.front().message.times_us.front() - kMaxOutside_us;
    const std::int64_t end_us = in_.sweeps.back().message.times_us.back() + kMaxOutside_us;
    Trajectory reference;
    std::size_t num_dropped = 0;
    std::size_t num_not_finite = 0;
    for (const auto& [pose, utime_us, begin] : in_.poses) {
      const bool is_within = pose.stamp_us >= begin_us && pose.stamp_us <= end_us;
      const Timestamp stamp{pose.stamp_us * kNanosecondsPerMicrosecond};
      const bool is_finite = std::isfinite(pose.x_m + pose.y_m + pose.theta_rad);
      if (!is_finite) {
        ++num_not_finite;
        continue;
      }
      const bool is_kept =
          is_within &&
          reference.append({stamp, Pose2(pose.x_m, pose.y_m, pose.theta_rad), std::nullopt});
      if (!is_kept) ++num_dropped;
    }
    if (num_dropped > 0) {
      out_.left_out["reference poses with a stamp outside the log or out of order left out"] =
          num_dropped;
    }
    if (num_not_finite > 0) {
      out_.left_out["reference poses that are not finite left out"] = num_not_finite;
    }
    if (!reference.empty()) out_.reference = std::move(reference);
  }

  MbotLog in_;
  const std::string& file_;
  const LcmOptions& options_;
  TickOdometry wheels_;
  ParsedLog out_;
};

}  // namespace

Result<ParsedLog> parse_lcm(std::string_view bytes, const std::string& file,
                            const LcmOptions& options) {
  auto messages = read_mbot_log(bytes, file);
  if (!messages) return tl::make_unexpected(messages.error());
  return LcmAssembler(std::move(*messages), file, options).run();
}

}  // namespace corridor::formats
