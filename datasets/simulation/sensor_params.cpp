#include "datasets/simulation/sensor_params.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "slam/core/units.hpp"

namespace corridor::simulation {
namespace {

// What a beam meets indoors, however far the sensor sees: the root mean square of the ranges of the
// rplidar-a1, which sees 12 m, is 3.6 to 3.8 m in the shipped corridors.
constexpr double kTypicalRange_m = 4;
constexpr double kTypicalIncidence_rad = std::numbers::pi / 4;

}  // namespace

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
  return {params.x_m, params.y_m, params.yaw_deg * kRadPerDeg};
}

double stated_range_sigma_m(const LidarParams& params) {
  const double range_m = std::min(params.range_max_m / 2, kTypicalRange_m);
  const double rounding_m = params.range_step_m / std::sqrt(12.0);  // uniform over a step
  return std::hypot(std::hypot(params.range_sigma_m, params.range_sigma_ratio * range_m),
                    params.range_sigma_incidence_m * std::tan(kTypicalIncidence_rad), rounding_m);
}

// A reading is the mean over its sampling interval: N / sqrt(interval).
double ImuParams::gyro_noise_radps() const { return gyro_noise_radps_rthz * std::sqrt(rate_hz); }
double ImuParams::accel_noise_mps2() const { return accel_noise_mps2_rthz * std::sqrt(rate_hz); }

}  // namespace corridor::simulation
