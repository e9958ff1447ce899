#include "slam/core/robot_model.hpp"

#include <fmt/format.h>

#include <cmath>

namespace corridor {
namespace {

// Longer is another unit; much longer leads out of what stamps hold.
constexpr double kMaxOffset_s = 1000;

struct Checker {
  std::vector<std::string> found;

  void positive(const char* key, double value) {
    if (!(std::isfinite(value) && value > 0)) {
      found.push_back(fmt::format("{} = {}: expected a finite number > 0", key, value));
    }
  }
  void not_negative(const char* key, double value) {
    if (!(std::isfinite(value) && value >= 0)) {
      found.push_back(fmt::format("{} = {}: expected a finite number >= 0", key, value));
    }
  }
  // Either way; not a number fails too.
  void within(const char* key, double value, double limit) {
    if (!(std::abs(value) <= limit)) {
      found.push_back(fmt::format("{} = {}: expected at most {} either way", key, value, limit));
    }
  }
  void finite(const char* key, bool is_finite) {
    if (!is_finite) found.push_back(fmt::format("{}: expected finite numbers", key));
  }
};

}  // namespace

std::vector<std::string> violations(const RobotModel& robot) {
  Checker check;
  check.positive("wheels.track_m", robot.wheels.track_m);
  check.positive("wheels.left_m_per_tick", robot.wheels.left_m_per_tick);
  check.positive("wheels.right_m_per_tick", robot.wheels.right_m_per_tick);
  check.not_negative("wheels.sigma_m_per_sqrt_m", robot.wheels.sigma_m_per_sqrt_m);
  check.finite("lidar pose", robot.lidar.T_base_lidar.is_finite());
  check.not_negative("lidar.range_min_m", robot.lidar.range_min_m);
  check.positive("lidar.range_max_m", robot.lidar.range_max_m);
  if (robot.lidar.range_min_m >= robot.lidar.range_max_m) {
    check.found.push_back(fmt::format("lidar.range_min_m = {}: expected less than range_max_m = {}",
                                      robot.lidar.range_min_m, robot.lidar.range_max_m));
  }
  check.not_negative("lidar.range_sigma_m", robot.lidar.range_sigma_m);
  check.within("lidar.scan_duration_s", robot.lidar.scan_duration_s, kMaxOffset_s);
  check.within("lidar.time_offset_s", robot.lidar.time_offset_s, kMaxOffset_s);
  check.finite("imu pose", robot.imu.T_base_imu.is_finite());
  check.positive("imu.rate_hz", robot.imu.rate_hz);
  check.not_negative("imu.gyro_noise_radps", robot.imu.gyro_noise_radps);
  check.not_negative("imu.accel_noise_mps2", robot.imu.accel_noise_mps2);
  check.not_negative("imu.gyro_bias_walk_radps_sqrt_s", robot.imu.gyro_bias_walk_radps_sqrt_s);
  check.not_negative("imu.accel_bias_walk_mps2_sqrt_s", robot.imu.accel_bias_walk_mps2_sqrt_s);
  return check.found;
}

}  // namespace corridor
