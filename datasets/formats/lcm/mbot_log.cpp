#include "datasets/formats/lcm/mbot_log.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace corridor::formats {
namespace {

constexpr std::string_view kScanChannelEnd = "_LASER_SCAN";
constexpr std::string_view kTicksChannel = "MAEBOT_MOTOR_FEEDBACK";
constexpr std::string_view kImuChannel = "MAEBOT_SENSOR_DATA";
constexpr std::string_view kPoseChannel = "MAEBOT_POSE";
// A turn of the LiDAR takes a seventh of a second; beams farther from the scan's stamp belong to
// another clock or to broken bits.
constexpr std::int64_t kMaxSweep_us = 1'000'000;
// Angles of degrees, or of broken bits, lie beyond.
constexpr double kMaxAngle_rad = 2 * std::numbers::pi + 1e-3;

class MbotLogReader {
 public:
  explicit MbotLogReader(const std::string& file) : file_(file) {}

  Result<void> take(const LcmEvent& event) {
    if (event.channel.ends_with(kScanChannelEnd)) return take_scan(event);
    if (event.channel == kTicksChannel) {
      ++log_.left_out["wheel messages lose the values of their motors"];
      return keep(decode_ticks(event, file_), event, log_.ticks);
    }
    if (event.channel == kImuChannel) {
      ++log_.left_out["IMU messages lose all but yaw rate and horizontal acceleration"];
      return keep(decode_imu(event, file_), event, log_.imu);
    }
    if (event.channel == kPoseChannel) return keep(decode_pose(event, file_), event, log_.poses);
    ++log_.left_out["messages on channels of no use left out"];
    return {};
  }

  MbotLog finish() { return std::move(log_); }

 private:
  template <class T>
  Result<void> keep(Result<T> message, const LcmEvent& event, std::vector<Received<T>>& list) {
    if (!message) return tl::make_unexpected(message.error());
    list.push_back({std::move(*message), event.utime_us, event.begin});
    return {};
  }

  Result<void> take_scan(const LcmEvent& event) {
    auto scan = decode_scan(event, file_);
    if (!scan) return tl::make_unexpected(scan.error());
    if (!lidar_channel_) lidar_channel_ = event.channel;
    if (event.channel != *lidar_channel_) {
      ++log_.left_out["scans of a second LiDAR left out"];
      return {};
    }
    ++log_.left_out["scans lose their intensities"];
    return keep(sweep_of(*scan, event), event, log_.sweeps);
  }

  [[nodiscard]] tl::unexpected<Error> failure(const LcmEvent& event, std::string what,
                                              std::string expected) const {
    return fail(ErrorCode::kInvalid, std::move(what),
                fmt::format("{}: byte {}", file_, event.begin), std::move(expected));
  }

  Result<Sweep> sweep_of(const MbotScan& scan, const LcmEvent& event) {
    Sweep sweep;
    for (std::size_t beam = 0; beam < scan.ranges_m.size(); ++beam) {
      const double angle_rad = scan.angles_rad[beam];
      if (!(std::abs(angle_rad) <= kMaxAngle_rad)) {
        return failure(event, fmt::format("beam {} points to {} rad", beam, angle_rad),
                       "an angle within one turn of 0");
      }
      const std::int64_t since_us = scan.times_us[beam] - scan.stamp_us;
      if (since_us < -kMaxSweep_us || since_us > kMaxSweep_us) {
        return failure(event, fmt::format("beam {} was taken {} us after the scan", beam, since_us),
                       fmt::format("at most {} us", kMaxSweep_us));
      }
      if (beam > 0 && scan.times_us[beam] < scan.times_us[beam - 1]) {
        return failure(event, fmt::format("time of beam {} steps back", beam), "times in order");
      }
      const auto range_m = range_of(scan.ranges_m[beam]);
      if (!range_m) {
        return failure(event, fmt::format("beam {} has the range nan", beam), "a number");
      }
      sweep.ranges_m.push_back(*range_m);
    }
    sweep.angles_rad.assign(scan.angles_rad.begin(), scan.angles_rad.end());
    sweep.times_us = scan.times_us;
    return sweep;
  }

  // The sensor says 0 where nothing came back, and so does what is left of a range it cannot say:
  // its driver counts quarter millimetres in 16 bits with sign, so that 8.192 m becomes -8.192 m.
  std::optional<double> range_of(float range_m) {
    if (std::isnan(range_m)) return std::nullopt;
    if (range_m > 0 && std::isfinite(range_m)) return range_m;
    if (range_m == 0) {
      count_no_return(range_m, std::numeric_limits<double>::infinity(), log_.counts);
    } else if (range_m < 0) {
      ++log_.counts["beams of negative range taken as no return"];
    } else {
      ++log_.counts["beams of infinite range taken as no return"];
    }
    return 0.0;
  }

  const std::string& file_;
  MbotLog log_;
  std::optional<std::string_view> lidar_channel_;
};

}  // namespace

Result<MbotLog> read_mbot_log(std::string_view bytes, const std::string& file) {
  const auto events = split_lcm_events(bytes, file);
  if (!events) return tl::make_unexpected(events.error());
  MbotLogReader reader(file);
  for (const LcmEvent& event : *events) {
    if (auto taken = reader.take(event); !taken) return tl::make_unexpected(taken.error());
  }
  return reader.finish();
}

}  // namespace corridor::formats
