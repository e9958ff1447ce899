#include "datasets/formats/log_suspicions.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace corridor::formats {
namespace {

// No sensor of a moving robot is as slow, none of the LiDARs as fast.
constexpr double kSlowestStep_s = 4;
constexpr double kFastestScan_s = 2e-3;
// In milliseconds even the slowest readings are no farther apart.
constexpr double kSlowestStep_ms = 1000 * kSlowestStep_s;
// Ranges of planar LiDARs: farther is centimetres or millimetres, nearer a factor too many.
constexpr double kFarRange_m = 100;
constexpr double kFarLimit_m = 1000;
constexpr double kNearRange_m = 0.1;
constexpr double kMostlyInvalid_ratio = 0.95;
// Returns at exactly one far range: in recorded logs less than a fifth as many share one.
constexpr double kSharedRange_ratio = 5e-3;
constexpr std::size_t kLeastShared = 20;
// No robot indoors is as fast.
constexpr double kFastWheels_mps = 5;
// Half of gravity: no robot keeps that up over half a log.
constexpr double kHalfGravity_mps2 = 4.9;
// Degrees for radians is a factor of 57.3, give or take slip and bias.
constexpr double kDegreesFactor_low = 30;
constexpr double kDegreesFactor_high = 110;
constexpr double kSameTurn_ratio = 0.3;
constexpr double kSameRate_factor = 2;
// Recorded logs have at most 5 % of their way across their headings. Headings in degrees are as
// good as drawn: 64 % +- 31 % of a chord, +- 7 % of twenty.
constexpr double kSideways_ratio = 0.45;
constexpr std::size_t kLeastChords = 20;
// Robots that drive on floors: no smaller than a hand, no larger than a car.
constexpr double kNarrowestTrack_m = 0.03;
constexpr double kLargestRobot_m = 3;
// As few as make a score of `run` doubtful.
constexpr double kFewPoses_ratio = 0.5;
// Feet for metres, the units that differ least, make 3.28; to make 3, wheels would have to slip
// over two thirds of their way, and a drive of less than this may be a push or a turn of one wheel.
constexpr double kOtherPath_factor = 3;
constexpr double kLeastPath_m = 1;
// A scan that stays the same to the last bit of 32 over as long a way or turn: noise alone changes
// it, and without noise only a corridor without ends does not.
constexpr double kFrozenPath_m = 0.5;
constexpr double kFrozenTurn_rad = 0.5;

class Suspicions {
 public:
  Suspicions(const LogHealth& health, const RobotModel& robot, const LogLimits& limits)
      : health_(health), robot_(robot), limits_(limits) {}

  std::vector<std::string> run() {
    suspect_stamps("LiDAR", health_.lidar_stamps);
    suspect_stamps("wheels", health_.wheel_stamps);
    suspect_stamps("IMU", health_.imu_stamps);
    if (health_.lidar) suspect_lidar(*health_.lidar);
    if (health_.wheels) suspect_wheels(*health_.wheels);
    if (health_.imu) suspect_imu(*health_.imu);
    suspect_robot();
    if (health_.truth) suspect_truth(*health_.truth);
    return std::move(found_);
  }

 private:
  void add(std::string line) { found_.push_back(std::move(line)); }

  void suspect_robot() {
    const double track_m = robot_.wheels.track_m;
    if (track_m < kNarrowestTrack_m || track_m > kLargestRobot_m) {
      add(fmt::format("robot model: a track of {} m; another unit?", track_m));
    }
    suspect_mounting("LiDAR", robot_.lidar.T_base_lidar);
    suspect_mounting("IMU", robot_.imu.T_base_imu);
  }

  void suspect_mounting(const char* sensor, const Pose2& T_base_sensor) {
    const double distance_m = T_base_sensor.translation_m().norm();
    if (distance_m < kLargestRobot_m) return;
    add(fmt::format("robot model: a {} {} m away from the base; another unit?", sensor,
                    distance_m));
  }

  void suspect_truth(const TruthHealth& truth) {
    if (truth.scans_with_pose_ratio == 0) {
      add("truth: no scan has a true pose within 10 ms; another clock, unit or log?");
    } else if (truth.scans_with_pose_ratio < kFewPoses_ratio) {
      add(
          fmt::format("truth: {:.1f} % of the scans have a true pose within 10 ms; cut short, or "
                      "another clock?",
                      100 * truth.scans_with_pose_ratio));
    }
    if (truth.num_fast_steps > 0) {
      add(fmt::format(
          "truth: {} steps faster than {} m/s, the first until {:.3f} s; centimetres or "
          "millimetres for metres, or a jump?",
          truth.num_fast_steps, limits_.max_speed_mps, truth.first_fast_step_s));
    }
    const double ratio = truth.common_path_m / truth.common_wheel_path_m;
    if (truth.common_wheel_path_m < kLeastPath_m ||
        (ratio < kOtherPath_factor && ratio > 1 / kOtherPath_factor)) {
      return;
    }
    add(fmt::format(
        "truth: a path {:.4g} times as long as that of the wheels ({:.3f} m, {:.3f} m); "
        "another unit, or another log's?",
        ratio, truth.common_path_m, truth.common_wheel_path_m));
  }

  void suspect_stamps(const char* sensor, const StampHealth& stamps) {
    if (stamps.median_step_s > kSlowestStep_s) {
      add(fmt::format("{}: {:.3f} s between readings; {} for seconds?", sensor,
                      stamps.median_step_s,
                      stamps.median_step_s > kSlowestStep_ms ? "microseconds" : "milliseconds"));
    }
    if (stamps.longest_gap_s > kSlowestStep_s && stamps.num_gaps > 0) {
      add(fmt::format(
          "{}: no reading for {:.3f} s before {}; a clock that jumps, or a break in the "
          "recording?",
          sensor, stamps.longest_gap_s, stamps.longest_gap_at));
    }
    const bool is_lidar = &stamps == &health_.lidar_stamps;
    if (is_lidar && stamps.median_step_s > 0 && stamps.median_step_s < kFastestScan_s) {
      add(fmt::format("{}: {:.6f} s between scans; seconds for milliseconds?", sensor,
                      stamps.median_step_s));
    }
  }

  void suspect_lidar(const LidarHealth& lidar) {
    const double whole_turn_rad = 2 * std::numbers::pi * (1 + 1e-3);
    if (lidar.field_of_view_rad > whole_turn_rad) {
      add(fmt::format("LiDAR: a field of view of {:.1f} rad; degrees for radians?",
                      lidar.field_of_view_rad));
    }
    if (lidar.median_range_m > kFarRange_m || lidar.range_limit_m > kFarLimit_m) {
      add(fmt::format(
          "LiDAR: ranges of {:.1f} m at the median, up to {:.1f} m ({}), with a limit of "
          "{:.1f} m; centimetres or millimetres for metres?",
          lidar.median_range_m, lidar.max_range_m, lidar.longest_range_at, lidar.range_limit_m));
    }
    if (lidar.max_range_m > 0 && lidar.max_range_m < kNearRange_m) {
      add(
          fmt::format("LiDAR: no range is longer than {:.4f} m; metres taken for centimetres or "
                      "millimetres?",
                      lidar.max_range_m));
    }
    if (lidar.invalid_ratio == 1) {
      add(fmt::format(
          "LiDAR: no beam of any scan has a return, with a limit of {:.1f} m; ranges in "
          "centimetres or millimetres, or a limit in another unit?",
          lidar.range_limit_m));
    } else if (lidar.invalid_ratio > kMostlyInvalid_ratio) {
      add(fmt::format("LiDAR: {:.1f} % of the beams are without return; a limit in another unit?",
                      100 * lidar.invalid_ratio));
    }
    if (lidar.num_most_shared >= kLeastShared && lidar.most_shared_ratio > kSharedRange_ratio) {
      add(fmt::format(
          "LiDAR: {} returns ({:.2f} %) at exactly {:.3f} m; a code for no return, below "
          "the limit of {:.3f} m?",
          lidar.num_most_shared, 100 * lidar.most_shared_ratio, lidar.most_shared_range_m,
          lidar.range_limit_m));
    }
    if (lidar.frozen_path_m > kFrozenPath_m || lidar.frozen_turn_rad > kFrozenTurn_rad) {
      add(fmt::format(
          "LiDAR: {} scans until {} are exactly the same while the wheels move {:.3f} m "
          "and turn {:.3f} rad; a sensor that hangs?",
          lidar.num_frozen_scans, lidar.frozen_until, lidar.frozen_path_m, lidar.frozen_turn_rad));
    }
    const double step_s = health_.lidar_stamps.median_step_s;
    if (step_s > 0 && std::abs(robot_.lidar.scan_duration_s) > kSameRate_factor * step_s) {
      add(fmt::format("robot model: a sweep of {} s, but a scan every {:.4f} s",
                      robot_.lidar.scan_duration_s, step_s));
    }
  }

  void suspect_wheels(const WheelHealth& wheels) {
    if (wheels.max_speed_mps > kFastWheels_mps) {
      add(
          fmt::format("wheels: {:.2f} m/s ({}); centimetres or millimetres for metres, a jump, or "
                      "stamps in another unit?",
                      *wheels.max_speed_mps, wheels.max_speed_at));
    }
    if (wheels.max_yaw_rate_radps > limits_.max_yaw_rate_radps) {
      add(fmt::format("wheels: a turn at {:.2f} rad/s ({}); degrees for radians?",
                      *wheels.max_yaw_rate_radps, wheels.max_yaw_rate_at));
    }
    if (wheels.num_chords >= kLeastChords && wheels.sideways_ratio > kSideways_ratio) {
      add(fmt::format(
          "wheels: {:.0f} % of the way lies across the headings; degrees for radians, an axis that "
          "is another, or a robot that drives sideways?",
          100 * wheels.sideways_ratio));
    }
  }

  void suspect_imu(const ImuHealth& imu) {
    suspect_gravity('x', imu.median_accel_x_mps2);
    suspect_gravity('y', imu.median_accel_y_mps2);
    if (imu.max_gyro_radps > limits_.max_yaw_rate_radps) {
      add(fmt::format("IMU: a turn at {:.2f} rad/s ({}); degrees for radians?", imu.max_gyro_radps,
                      imu.max_gyro_at));
    }
    if (imu.gyro_turn_rad && imu.wheel_turn_rad) {
      suspect_turns(*imu.gyro_turn_rad, *imu.wheel_turn_rad);
    }
    const double rate_hz = health_.imu_stamps.median_rate_hz();
    if (rate_hz > 0 && (robot_.imu.rate_hz > kSameRate_factor * rate_hz ||
                        rate_hz > kSameRate_factor * robot_.imu.rate_hz)) {
      add(fmt::format("robot model: an IMU of {} Hz, but readings at {:.1f} Hz", robot_.imu.rate_hz,
                      rate_hz));
    }
  }

  void suspect_gravity(char axis, double median_mps2) {
    if (std::abs(median_mps2) < kHalfGravity_mps2) return;
    add(fmt::format("IMU: {} reads {:.2f} m/s2 at the median; gravity in a horizontal axis?", axis,
                    median_mps2));
  }

  void suspect_turns(double gyro_rad, double wheels_rad) {
    const double ratio = gyro_rad / wheels_rad;
    const std::string turns =
        fmt::format("IMU: the gyro turns {:.2f} times as far as the wheels", ratio);
    const double size = std::abs(ratio);
    if (size > kDegreesFactor_low && size < kDegreesFactor_high) {
      add(turns + "; its rates in degrees per second?");
    } else if (size > 1 / kDegreesFactor_high && size < 1 / kDegreesFactor_low) {
      add(turns + "; the wheels' headings in degrees?");
    } else if (ratio < 0) {
      add(turns + "; an axis that points down, or wheels exchanged?");
    } else if (std::abs(ratio - 1) > kSameTurn_ratio) {
      add(turns + "; a scale, the track, or slip?");
    }
  }

  const LogHealth& health_;
  const RobotModel& robot_;
  const LogLimits& limits_;
  std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> suspicions_of(const LogHealth& health, const RobotModel& robot,
                                       const LogLimits& limits) {
  return Suspicions(health, robot, limits).run();
}

}  // namespace corridor::formats
