#include <fmt/format.h>
// MRPT's serialization headers must precede those of the classes.
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/CSerializable.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <numbers>
#include <optional>

#include "datasets/formats/rawlog/rawlog.hpp"
#include "datasets/formats/rawlog/rawlog_framing.hpp"
#include "datasets/formats/rawlog/stated_readings.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

// 1601-01-01 to 1970-01-01 in ticks of 100 ns.
constexpr std::int64_t kUnixEpoch_ticks = 116'444'736'000'000'000;
constexpr std::int64_t kMaxTicks = kMaxStamp_ns / kRawlogTick_ns;  // from the Unix epoch
constexpr double kMaxTilt_rad = 1e-3;
constexpr double kFullTurn_rad = 2 * std::numbers::pi;
constexpr double kApertureRounding_rad = 1e-3;
constexpr float kBeyondLimit_m = 1.0F;

class RawlogParser {
 public:
  explicit RawlogParser(const std::string& file) : file_(file) { log_.origin_unit = "byte"; }

  Result<void> take(std::size_t offset, const mrpt::serialization::CSerializable& object) {
    offset_ = offset;
    if (const auto* comment = dynamic_cast<const mrpt::obs::CObservationComment*>(&object)) {
      return take_comment(*comment);
    }
    if (const auto* actions = dynamic_cast<const mrpt::obs::CActionCollection*>(&object)) {
      return take_actions(*actions);
    }
    if (const auto* frame = dynamic_cast<const mrpt::obs::CSensoryFrame*>(&object)) {
      return take_frame(*frame);
    }
    return take_observation(dynamic_cast<const mrpt::obs::CObservation&>(object));
  }

  Result<ParsedLog> finish() {
    // Actions behind the last frame have nothing but their own stamp.
    if (pending_stamp_) log_.add(WheelSample{*pending_stamp_, T_odom_base_, {}}, offset_);
    if (num_stated_ && *num_stated_ != log_.events.size()) {
      return fail(
          ErrorCode::kMalformed, fmt::format("{} readings", log_.events.size()), file_,
          fmt::format("{}, as the log's own comment says: it was cut, or its objects changed",
                      *num_stated_));
    }
    return std::move(log_);
  }

 private:
  tl::unexpected<Error> failure(ErrorCode code, std::string what, std::string expected) const {
    return fail(code, std::move(what), fmt::format("{}: byte {}", file_, offset_),
                std::move(expected));
  }

  Result<Timestamp> stamp_of_clock(const mrpt::Clock::time_point& time) const {
    const std::int64_t count = time.time_since_epoch().count();
    if (count < kUnixEpoch_ticks - kMaxTicks || count > kUnixEpoch_ticks + kMaxTicks) {
      return failure(ErrorCode::kInvalid, fmt::format("stamp of {} ticks since 1601", count),
                     "a time within 145 years of 1970");
    }
    return Timestamp{(count - kUnixEpoch_ticks) * kRawlogTick_ns};
  }

  Result<Pose2> planar(const mrpt::poses::CPose3D& pose, const char* what) const {
    const Pose2 T(pose.x(), pose.y(), std::isfinite(pose.yaw()) ? pose.yaw() : 0);
    if (!T.is_finite() || !std::isfinite(pose.yaw())) {
      return failure(ErrorCode::kInvalid, fmt::format("pose of {} is not finite", what),
                     "finite numbers");
    }
    if (!(std::abs(pose.pitch()) < kMaxTilt_rad && std::abs(pose.roll()) < kMaxTilt_rad)) {
      return failure(ErrorCode::kUnsupported, fmt::format("{} is tilted", what),
                     "pitch and roll of 0");
    }
    return T;
  }

  Result<void> take_comment(const mrpt::obs::CObservationComment& comment) {
    if (log_.robot_toml || !log_.events.empty()) {
      ++log_.left_out["later comments left out"];
    } else {
      const auto stated = stated_readings(comment.text, fmt::format("{}: byte {}", file_, offset_));
      if (!stated) return tl::make_unexpected(stated.error());
      num_stated_ = *stated;
      log_.robot_toml = comment.text;
    }
    return {};
  }

  Result<void> take_observation(const mrpt::obs::CObservation& observation) {
    if (const auto* scan = dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&observation)) {
      return take_scan(*scan);
    }
    if (const auto* odometry = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) {
      return take_odometry(*odometry);
    }
    return take_imu(dynamic_cast<const mrpt::obs::CObservationIMU&>(observation));
  }

  // The wheels' pose at a frame comes before the frame's first scan.
  Result<void> take_frame(const mrpt::obs::CSensoryFrame& frame) {
    if (frame.empty()) return {};
    const auto stamp = stamp_of_clock(frame.getObservationByIndex(0)->timestamp);
    if (!stamp) return tl::make_unexpected(stamp.error());
    if (pending_stamp_ || !has_frames_) log_.add(WheelSample{*stamp, T_odom_base_, {}}, offset_);
    pending_stamp_.reset();
    has_frames_ = true;
    for (const auto& observation : frame) {
      if (auto taken = take_observation(*observation); !taken) return taken;
    }
    return {};
  }

  Result<void> take_actions(const mrpt::obs::CActionCollection& actions) {
    for (std::size_t i = 0; i < actions.size(); ++i) {
      // The framing check lets in nothing but planar movements from odometry.
      const auto& movement = dynamic_cast<const mrpt::obs::CActionRobotMovement2D&>(actions.get(i));
      const auto& increment = movement.rawOdometryIncrementReading;
      if (i > 0) {
        ++log_.left_out["further movements of one action collection left out"];
        continue;
      }
      if (!std::isfinite(increment.x() + increment.y() + increment.phi())) {
        return failure(ErrorCode::kInvalid, "odometry increment is not finite", "finite numbers");
      }
      if (std::abs(increment.phi()) > kMaxHeading_rad) {
        return failure(ErrorCode::kInvalid, fmt::format("odometry turns by {}", increment.phi()),
                       fmt::format("at most {:g} rad", kMaxHeading_rad));
      }
      const auto stamp = stamp_of_clock(movement.timestamp);
      if (!stamp) return tl::make_unexpected(stamp.error());
      ++log_.left_out["actions lose their stamp and motion model, with velocities and ticks"];
      T_odom_base_ = T_odom_base_ * Pose2(increment.x(), increment.y(), increment.phi());
      pending_stamp_ = *stamp;
    }
    return {};
  }

  Result<void> take_odometry(const mrpt::obs::CObservationOdometry& odometry) {
    const auto stamp = stamp_of_clock(odometry.timestamp);
    if (!stamp) return tl::make_unexpected(stamp.error());
    const auto& pose = odometry.odometry;
    if (!std::isfinite(pose.x() + pose.y() + pose.phi())) {
      return failure(ErrorCode::kInvalid, "odometry pose is not finite", "finite numbers");
    }
    if (std::abs(pose.phi()) > kMaxHeading_rad) {
      return failure(ErrorCode::kInvalid, fmt::format("odometry with heading {}", pose.phi()),
                     fmt::format("at most {:g} rad", kMaxHeading_rad));
    }
    if (odometry.hasVelocities) ++log_.left_out["odometry readings lose their velocities"];
    WheelSample sample{*stamp, Pose2(pose.x(), pose.y(), pose.phi()), std::nullopt};
    if (odometry.hasEncodersInfo) {
      sample.ticks = WheelTicks{odometry.encoderLeftTicks, odometry.encoderRightTicks};
    }
    log_.add(sample, offset_);
    return {};
  }

  Result<void> take_imu(const mrpt::obs::CObservationIMU& imu) {
    using mrpt::obs::IMU_WZ;
    using mrpt::obs::IMU_X_ACC;
    using mrpt::obs::IMU_Y_ACC;
    if (!imu.has(IMU_WZ) || !imu.has(IMU_X_ACC) || !imu.has(IMU_Y_ACC)) {
      ++log_.left_out["IMU readings without yaw rate and both accelerations left out"];
      return {};
    }
    const auto stamp = stamp_of_clock(imu.timestamp);
    if (!stamp) return tl::make_unexpected(stamp.error());
    const auto T_base_imu = planar(imu.sensorPose, "the IMU");
    if (!T_base_imu) return tl::make_unexpected(T_base_imu.error());
    if (!log_.T_base_imu) log_.T_base_imu = *T_base_imu;
    constexpr std::ptrdiff_t kNumTaken = 3;
    if (std::count(imu.dataIsPresent.begin(), imu.dataIsPresent.end(), true) > kNumTaken) {
      ++log_.left_out["IMU readings lose all but yaw rate and horizontal acceleration"];
    }
    log_.add(ImuSample{*stamp, imu.get(IMU_WZ), imu.get(IMU_X_ACC), imu.get(IMU_Y_ACC)}, offset_);
    return {};
  }

  Result<void> take_scan(const mrpt::obs::CObservation2DRangeScan& scan) {
    if (!lidar_label_) lidar_label_ = scan.sensorLabel;
    if (scan.sensorLabel != *lidar_label_) {
      ++log_.left_out["scans of a second LiDAR left out"];
      return {};
    }
    const auto stamp = stamp_of_clock(scan.timestamp);
    if (!stamp) return tl::make_unexpected(stamp.error());
    const auto T_base_lidar = planar(scan.sensorPose, "the LiDAR");
    if (!T_base_lidar) return tl::make_unexpected(T_base_lidar.error());
    if (!(scan.aperture >= 0 && scan.aperture <= kFullTurn_rad + kApertureRounding_rad)) {
      return failure(ErrorCode::kInvalid, fmt::format("scan with aperture {} rad", scan.aperture),
                     "0 to 2 pi");
    }
    if (!(std::isfinite(scan.maxRange) && scan.maxRange > 0)) {
      return failure(ErrorCode::kInvalid, fmt::format("scan with maximum range {}", scan.maxRange),
                     "a finite number > 0");
    }
    count_left_out(scan);
    log_.stated_noise.take(scan.stdError);
    LaserScan taken;
    taken.stamp = *stamp;
    taken.T_base_lidar = *T_base_lidar;
    taken.range_max_m = scan.maxRange;
    take_beams(scan, taken);
    log_.add(std::move(taken), offset_);
    return {};
  }

  void count_left_out(const mrpt::obs::CObservation2DRangeScan& scan) {
    if (scan.hasIntensity()) ++log_.left_out["scans lose their intensities"];
    if (scan.beamAperture != 0 || scan.deltaPitch != 0) {
      ++log_.left_out["scans lose the width of their beams or their pitch"];
    }
  }

  // Beams of a clockwise scan are put into counter-clockwise order.
  void take_beams(const mrpt::obs::CObservation2DRangeScan& scan, LaserScan& taken) {
    const std::size_t n = scan.getScanSize();
    taken.angle_min_rad = -0.5 * static_cast<double>(scan.aperture);
    taken.angle_increment_rad = n < 2 ? 0.0 : scan.aperture / static_cast<double>(n - 1);
    taken.ranges_m.resize(n);
    taken.is_valid.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t source = scan.rightToLeft ? i : n - 1 - i;
      float range_m = scan.getScanRange(source);
      const bool is_valid = scan.getScanRangeValidity(source);
      if (!is_valid && !(std::isfinite(range_m) && range_m >= 0)) {
        ++log_.counts
              ["raw ranges of beams without return that were negative or not finite, replaced"];
        range_m = scan.maxRange + kBeyondLimit_m;
      } else if (!is_valid) {
        count_no_return(range_m, scan.maxRange, log_.counts);
      }
      taken.ranges_m[i] = range_m;
      taken.is_valid[i] = is_valid ? 1 : 0;
    }
    if (!scan.rightToLeft) ++log_.counts["clockwise scans put into counter-clockwise order"];
  }

  const std::string& file_;
  std::size_t offset_ = 0;
  ParsedLog log_;
  std::optional<std::uint64_t> num_stated_;
  std::optional<std::string> lidar_label_;
  // Actions since the last sensory frame.
  Pose2 T_odom_base_;
  std::optional<Timestamp> pending_stamp_;
  bool has_frames_ = false;
};

}  // namespace

Result<ParsedLog> parse_rawlog(std::string_view bytes, const std::string& file) {
  const auto frames = check_rawlog_frames(bytes, file);
  if (!frames) return tl::make_unexpected(frames.error());
  RawlogParser parser(file);
  for (const RawlogFrame& frame : *frames) {
    try {
      mrpt::io::CMemoryStream stream;
      stream.assignMemoryNotOwn(bytes.data() + frame.begin, frame.size);
      auto archive = mrpt::serialization::archiveFrom(stream);
      const auto object = archive.ReadObject();
      if (auto taken = parser.take(frame.begin, *object); !taken) {
        return tl::make_unexpected(taken.error());
      }
    } catch (const std::exception& error) {
      return fail(ErrorCode::kMalformed, fmt::format("MRPT cannot read the {}", frame.class_name),
                  fmt::format("{}: byte {}", file, frame.begin), "an object MRPT 2.5 reads");
    }
  }
  return parser.finish();
}

}  // namespace corridor::formats
