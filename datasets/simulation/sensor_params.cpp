#include "datasets/simulation/sensor_params.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace corridor::simulation {

std::vector<std::string> LidarParams::relations() const {
  std::vector<std::string> found;
  if (!(range_min_m < range_max_m)) {
    found.push_back(fmt::format("range_min_m = {}: expected less than range_max_m = {}",
                                range_min_m, range_max_m));
  }
  if (!(scan_duration_s < 1 / rate_hz)) {
    found.push_back(fmt::format("scan_duration_s = {}: expected less than the {} s between scans",
                                scan_duration_s, 1 / rate_hz));
  }
  return found;
}

Pose2 T_base_lidar(const LidarParams& params) {
  return {params.x_m, params.y_m, params.yaw_deg * (std::numbers::pi / 180)};
}

// A reading is the mean over its sampling interval: N / sqrt(interval).
double ImuParams::gyro_noise_radps() const { return gyro_noise_radps_rthz * std::sqrt(rate_hz); }
double ImuParams::accel_noise_mps2() const { return accel_noise_mps2_rthz * std::sqrt(rate_hz); }

}  // namespace corridor::simulation
