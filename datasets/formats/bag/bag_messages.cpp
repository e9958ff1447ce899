#include "datasets/formats/bag/bag_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "datasets/formats/trajectories/trajectory_rules.hpp"

namespace corridor::formats {
namespace {

constexpr float kBeyondLimit_m = 1.0F;
constexpr double kFullTurn_rad = 2 * std::numbers::pi;
// A wheel that turned farther than this is a corrupted number: 1e9 turns are 1e6 km of most wheels.
constexpr double kMaxTurns = 1e9;
// A sweep that takes longer is a corrupted number (as lidar.scan_duration_s).
constexpr double kMaxSweep_s = 1000;

template <class... T>
bool are_finite(T... numbers) {
  return (std::isfinite(numbers) && ...);
}

// The angle from first to last beam spans n - 1 steps, or n where drivers count one too many.
bool fits_beam_count(const ros1::Scan& scan) {
  const auto n = static_cast<double>(scan.ranges_m.size());
  if (n < 2) return true;
  const double num_steps =
      (static_cast<double>(scan.angle_max_rad) - scan.angle_min_rad) / scan.angle_increment_rad;
  return num_steps > n - 1.5 && num_steps < n + 0.5;
}

// From the first beam of the message to its last; negative where the driver counts backwards.
double sweep_s(const ros1::Scan& scan) {
  return static_cast<double>(scan.time_increment_s) *
         (static_cast<double>(scan.ranges_m.size()) - 1);
}

Result<void> check_geometry(const ros1::Scan& scan, const std::string& where) {
  if (!are_finite(scan.angle_min_rad, scan.angle_max_rad, scan.angle_increment_rad,
                  scan.time_increment_s, scan.range_min_m, scan.range_max_m)) {
    return fail(ErrorCode::kInvalid, "an angle, a limit or a time of a scan is not finite", where,
                "finite numbers");
  }
  if (!(scan.range_max_m > 0 && scan.range_min_m >= 0 && scan.range_min_m < scan.range_max_m)) {
    return fail(ErrorCode::kInvalid,
                fmt::format("ranges from {} m to {} m", scan.range_min_m, scan.range_max_m), where,
                "0 <= range_min < range_max");
  }
  if (scan.ranges_m.empty()) {
    return fail(ErrorCode::kInvalid, "a scan without beams", where, "at least one");
  }
  if (!fits_beam_count(scan)) {
    return fail(ErrorCode::kInvalid, fmt::format("{} ranges", scan.ranges_m.size()), where,
                fmt::format("beams from {} rad to {} rad in steps of {} rad", scan.angle_min_rad,
                            scan.angle_max_rad, scan.angle_increment_rad));
  }
  if (exceeds_full_turn(scan.ranges_m.size(), scan.angle_increment_rad)) {
    return fail(
        ErrorCode::kInvalid,
        fmt::format("{} beams in steps of {} rad", scan.ranges_m.size(), scan.angle_increment_rad),
        where, "a fan of at most 2 pi (degrees for radians?)");
  }
  if (!(std::abs(sweep_s(scan)) <= kMaxSweep_s)) {
    return fail(ErrorCode::kInvalid, fmt::format("a sweep of {} s", sweep_s(scan)), where,
                fmt::format("at most {} s", kMaxSweep_s));
  }
  return {};
}

}  // namespace

Result<std::optional<SensorEvent>> BagMessageReader::take(const ros1::Message& message,
                                                          const std::string& where) {
  const Timestamp stamp{message.stamp_ns};
  // rosbag has no time of 0.
  if (std::max<std::int64_t>(message.stamp_ns, 1) != message.record_ns) {
    ++log_.left_out["messages lose the time of their recording"];
  }
  if (const auto* scan = std::get_if<ros1::Scan>(&message.content)) {
    return take_scan(*scan, stamp, where);
  }
  if (const auto* odometry = std::get_if<ros1::Odometry>(&message.content)) {
    return take_odometry(*odometry, stamp, where);
  }
  if (const auto* imu = std::get_if<ros1::Imu>(&message.content)) {
    return take_imu(*imu, stamp, where);
  }
  return take_joints(std::get<ros1::Joints>(message.content), stamp, where);
}

BagMessageReader::Taken BagMessageReader::take_scan(const ros1::Scan& scan, Timestamp stamp,
                                                    const std::string& where) {
  if (auto good = check_geometry(scan, where); !good) return tl::make_unexpected(good.error());
  if (!scan.intensities.empty()) ++log_.left_out["scans lose their intensities"];
  if (scan.scan_time_s != 0) ++log_.left_out["scans lose the time that they say is between scans"];
  LaserScan taken;
  taken.stamp = stamp;
  taken.duration_s = sweep_s(scan);
  taken.range_max_m = scan.range_max_m;
  const bool is_clockwise = scan.angle_increment_rad < 0;
  const auto num_steps = static_cast<double>(scan.ranges_m.size() - 1);
  const double increment_rad = scan.angle_increment_rad;
  taken.angle_increment_rad = std::abs(increment_rad);
  taken.angle_min_rad =
      is_clockwise ? scan.angle_min_rad + num_steps * increment_rad : scan.angle_min_rad;
  if (auto good = take_beams(scan, where, taken); !good) return tl::make_unexpected(good.error());
  if (is_clockwise) {
    std::reverse(taken.ranges_m.begin(), taken.ranges_m.end());
    std::reverse(taken.is_valid.begin(), taken.is_valid.end());
    // The message's last beam is beam 0 now, and its moment the scan's stamp.
    taken.stamp = add_seconds(stamp, taken.duration_s);
    taken.duration_s = -taken.duration_s;
    log_.has_clockwise_scans = true;
    ++log_.counts["clockwise scans put into counter-clockwise order"];
  }
  keep_limits(scan);
  return SensorEvent{std::move(taken)};
}

Result<void> BagMessageReader::take_beams(const ros1::Scan& scan, const std::string& where,
                                          LaserScan& taken) {
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    float range_m = scan.ranges_m[i];
    if (std::isfinite(range_m) && range_m < 0) {
      return fail(ErrorCode::kInvalid, fmt::format("range {} m of beam {}", range_m, i), where,
                  "a range >= 0");
    }
    const bool is_valid = range_m > 0 && range_m >= scan.range_min_m && range_m <= scan.range_max_m;
    if (!std::isfinite(range_m)) {
      ++log_.counts[std::isnan(range_m)
                        ? "NaN ranges taken as no return, replaced by the limit + 1 m"
                        : "infinite ranges taken as no return, replaced by the limit + 1 m"];
      range_m = scan.range_max_m + kBeyondLimit_m;
    } else if (range_m > 0 && range_m < scan.range_min_m) {
      ++log_.counts["beams below the sensor's minimum taken as no return"];
    } else if (!is_valid) {
      count_no_return(range_m, scan.range_max_m, log_.counts);
    }
    taken.ranges_m.push_back(range_m);
    taken.is_valid.push_back(is_valid ? 1 : 0);
  }
  return {};
}

// The first scan's minimum counts for the robot model. Drivers that say nothing of time leave it to
// the model.
void BagMessageReader::keep_limits(const ros1::Scan& scan) {
  const double range_min_m = scan.range_min_m;
  if (!log_.range_min_m) log_.range_min_m = range_min_m;
  if (*log_.range_min_m != range_min_m) {
    ++log_.counts["scans whose minimum range is not the first scan's, which is used"];
  }
  if (scan.time_increment_s != 0) log_.scans_state_duration = true;
}

BagMessageReader::Taken BagMessageReader::take_odometry(const ros1::Odometry& odometry,
                                                        Timestamp stamp, const std::string& where) {
  if (!are_finite(odometry.x_m, odometry.y_m, odometry.qx, odometry.qy, odometry.qz, odometry.qw)) {
    return fail(ErrorCode::kInvalid, "odometry pose is not finite", where, "finite numbers");
  }
  if (odometry.has_more) ++log_.left_out["odometry messages lose twist, covariances or height"];
  const auto yaw_rad = yaw_of_quaternion(odometry.qx, odometry.qy, odometry.qz, odometry.qw, where);
  if (!yaw_rad) return tl::make_unexpected(yaw_rad.error());
  return SensorEvent{WheelSample{stamp, Pose2(odometry.x_m, odometry.y_m, *yaw_rad), std::nullopt}};
}

BagMessageReader::Taken BagMessageReader::take_imu(const ros1::Imu& imu, Timestamp stamp,
                                                   const std::string& where) {
  if (!imu.has_gyro || !imu.has_accel) {
    ++log_.left_out["IMU readings that state no angular velocity or acceleration left out"];
    return std::nullopt;
  }
  if (imu.has_more) {
    ++log_.left_out["IMU readings lose orientation, the other axes or covariances"];
  }
  if (!are_finite(imu.gyro_z_radps, imu.accel_x_mps2, imu.accel_y_mps2)) {
    return fail(ErrorCode::kInvalid, "an IMU reading is not finite", where, "finite numbers");
  }
  return SensorEvent{ImuSample{stamp, imu.gyro_z_radps, imu.accel_x_mps2, imu.accel_y_mps2}};
}

BagMessageReader::Taken BagMessageReader::take_joints(const ros1::Joints& joints, Timestamp stamp,
                                                      const std::string& where) {
  if (joints.has_more || joints.names.size() > 2) {
    ++log_.left_out["joint messages lose velocities, efforts or other joints"];
  }
  std::optional<std::int64_t> ticks[2];
  const std::string names[2] = {joints_->left, joints_->right};
  for (int side = 0; side < 2; ++side) {
    const auto name = std::find(joints.names.begin(), joints.names.end(), names[side]);
    if (name == joints.names.end()) continue;
    const auto index = static_cast<std::size_t>(name - joints.names.begin());
    if (joints.positions_rad.size() != joints.names.size()) {
      return fail(ErrorCode::kInvalid,
                  fmt::format("{} joint positions", joints.positions_rad.size()), where,
                  fmt::format("one for each of {} joints", joints.names.size()));
    }
    const double turns = joints.positions_rad[index] / kFullTurn_rad;
    if (!(std::abs(turns) <= kMaxTurns)) {
      return fail(
          ErrorCode::kInvalid,
          fmt::format("position {} rad of joint {}", joints.positions_rad[index], names[side]),
          where, fmt::format("at most {:g} turns", kMaxTurns));
    }
    ticks[side] = std::llround(turns * static_cast<double>(joints_->ticks_per_turn));
  }
  if (!ticks[0] || !ticks[1]) {
    ++log_.left_out["joint messages without both wheels left out"];
    return std::nullopt;
  }
  return SensorEvent{WheelSample{stamp, Pose2(), WheelTicks{*ticks[0], *ticks[1]}}};
}

}  // namespace corridor::formats
