#include <fmt/format.h>
// MRPT's serialization headers must precede those of the classes.
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/CSerializable.h>
#include <mrpt/serialization/archiveFrom_std_streams.h>

#include <cmath>
#include <exception>
#include <limits>
#include <sstream>

#include "datasets/formats/rawlog/rawlog.hpp"
#include "datasets/formats/rawlog/stated_readings.hpp"
#include "datasets/formats/robot_toml.hpp"

namespace corridor::formats {
namespace {

constexpr std::int64_t kUnixEpoch_ticks = 116'444'736'000'000'000;
// Half the distance between two beams, in which a printed angle may differ from the middle.
constexpr double kSameAngle_rad = 1e-6;

// To the nearest tick.
mrpt::Clock::time_point clock_of(Timestamp stamp) {
  const std::int64_t floor_ticks = stamp.nanoseconds / kRawlogTick_ns;
  const std::int64_t rest_ns = stamp.nanoseconds % kRawlogTick_ns;
  const std::int64_t rounding =
      rest_ns >= kRawlogTick_ns / 2 ? 1 : (rest_ns < -kRawlogTick_ns / 2 ? -1 : 0);
  return mrpt::Clock::time_point(mrpt::Clock::duration(floor_ticks + rounding + kUnixEpoch_ticks));
}

double middle_angle_rad(const LaserScan& scan) {
  const double last_rad =
      scan.angle_min_rad + scan.angle_increment_rad *
                               static_cast<double>(std::max<std::size_t>(scan.num_beams(), 1) - 1);
  return 0.5 * (scan.angle_min_rad + last_rad);
}

mrpt::poses::CPose3D pose3_of(const Pose2& T) { return {T.x_m(), T.y_m(), 0, T.theta_rad(), 0, 0}; }

bool fits_int32(std::int64_t value) {
  return value >= std::numeric_limits<std::int32_t>::min() &&
         value <= std::numeric_limits<std::int32_t>::max();
}

class RawlogWriter {
 public:
  explicit RawlogWriter(const RobotModel& robot) : robot_(robot) {}

  // False if the event does not fit.
  bool write(const LaserScan& scan) {
    mrpt::obs::CObservation2DRangeScan out;
    out.sensorLabel = "LIDAR";
    out.timestamp = clock_of(scan.stamp);
    out.rightToLeft = true;
    out.aperture =
        static_cast<float>(scan.angle_increment_rad *
                           static_cast<double>(std::max<std::size_t>(scan.num_beams(), 1) - 1));
    out.maxRange = static_cast<float>(scan.range_max_m);
    out.stdError = static_cast<float>(robot_.lidar.range_sigma_m);
    out.sensorPose = pose3_of(centred_lidar_pose(scan));
    out.resizeScan(scan.num_beams());
    for (std::size_t i = 0; i < scan.num_beams(); ++i) {
      out.setScanRange(i, scan.ranges_m[i]);
      out.setScanRangeValidity(i, scan.is_valid[i] != 0);
    }
    archive_ << out;
    return true;
  }

  bool write(const WheelSample& sample) {
    mrpt::obs::CObservationOdometry out;
    out.sensorLabel = "WHEELS";
    out.timestamp = clock_of(sample.stamp);
    // Not by CPose2D's constructor: its wrapping loses the angle's last bits.
    out.odometry.x(sample.T_odom_base.x_m());
    out.odometry.y(sample.T_odom_base.y_m());
    out.odometry.phi(sample.T_odom_base.theta_rad());
    out.hasEncodersInfo = sample.ticks.has_value();
    if (sample.ticks) {
      if (!fits_int32(sample.ticks->left) || !fits_int32(sample.ticks->right)) return false;
      out.encoderLeftTicks = static_cast<std::int32_t>(sample.ticks->left);
      out.encoderRightTicks = static_cast<std::int32_t>(sample.ticks->right);
    }
    archive_ << out;
    return true;
  }

  bool write(const ImuSample& sample) {
    mrpt::obs::CObservationIMU out;
    out.sensorLabel = "IMU";
    out.timestamp = clock_of(sample.stamp);
    out.sensorPose = pose3_of(robot_.imu.T_base_imu);
    out.set(mrpt::obs::IMU_WZ, sample.gyro_z_radps);
    out.set(mrpt::obs::IMU_X_ACC, sample.accel_x_mps2);
    out.set(mrpt::obs::IMU_Y_ACC, sample.accel_y_mps2);
    archive_ << out;
    return true;
  }

  void write_comment(const std::string& text, Timestamp stamp) {
    mrpt::obs::CObservationComment out;
    out.timestamp = clock_of(stamp);
    out.text = text;
    archive_ << out;
  }

  std::string bytes() const { return stream_.str(); }

 private:
  const RobotModel& robot_;
  // MRPT's own CMemoryStream grows by a page at a time and copies everything each time.
  std::ostringstream stream_;
  mrpt::serialization::CArchiveStreamBase<std::ostream> archive_{stream_};
};

// The calibration as the file's scans will show it.
RobotModel robot_of_file(const SensorLog& log) {
  RobotModel robot = log.robot;
  for (const SensorEvent& event : log.events) {
    if (const auto* scan = std::get_if<LaserScan>(&event)) {
      robot.lidar.T_base_lidar = centred_lidar_pose(*scan);
      robot.lidar.range_max_m = scan->range_max_m;
      break;
    }
  }
  return robot;
}

}  // namespace

Pose2 centred_lidar_pose(const LaserScan& scan) {
  const double middle_rad = middle_angle_rad(scan);
  if (std::abs(middle_rad) < kSameAngle_rad) return scan.T_base_lidar;
  return scan.T_base_lidar * Pose2(0, 0, middle_rad);
}

Result<std::string> rawlog_bytes(const SensorLog& log) {
  try {
    RawlogWriter writer(log.robot);
    const Timestamp begin = log.events.empty() ? Timestamp{} : stamp_of(log.events.front());
    writer.write_comment(
        stated_readings_line(log.events.size()) + robot_to_toml(robot_of_file(log)), begin);
    for (std::size_t i = 0; i < log.events.size(); ++i) {
      const bool fits = std::visit([&writer](const auto& reading) { return writer.write(reading); },
                                   log.events[i]);
      if (!fits) {
        return fail(ErrorCode::kUnsupported, "tick count too large for a rawlog",
                    fmt::format("event {}", i), "32 bits");
      }
    }
    return writer.bytes();
  } catch (const std::exception& error) {
    return fail(ErrorCode::kInternal, "MRPT cannot write the log");
  }
}

}  // namespace corridor::formats
