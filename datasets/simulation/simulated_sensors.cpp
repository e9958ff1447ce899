#include "datasets/simulation/simulated_sensors.hpp"

#include <cmath>
#include <numbers>

namespace corridor::simulation {
namespace {

// Angle of beam 0 in the base frame; half an increment past -pi, so that no beam is at the seam.
double first_beam_rad(int num_beams) { return -std::numbers::pi + std::numbers::pi / num_beams; }

double beam_increment_rad(int num_beams) { return 2 * std::numbers::pi / num_beams; }

}  // namespace

std::vector<std::optional<RayCaster::Hit>> cast_beams(const RayCaster& caster,
                                                      const Pose2& T_world_base,
                                                      const LidarParams& params) {
  const double first_rad = T_world_base.theta_rad() + first_beam_rad(params.num_beams);
  std::vector<std::optional<RayCaster::Hit>> hits;
  hits.reserve(static_cast<std::size_t>(params.num_beams));
  for (int i = 0; i < params.num_beams; ++i) {
    hits.push_back(caster.cast(T_world_base.translation_m(),
                               first_rad + i * beam_increment_rad(params.num_beams),
                               params.range_max_m));
  }
  return hits;
}

LaserScan measure_scan(const std::vector<std::optional<RayCaster::Hit>>& hits, Timestamp stamp,
                       const LidarParams& params, Rng rng) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.angle_min_rad = first_beam_rad(params.num_beams);
  scan.angle_increment_rad = beam_increment_rad(params.num_beams);
  scan.range_min_m = params.range_min_m;
  scan.range_max_m = params.range_max_m;
  for (const auto& hit : hits) {
    const double noise_m = rng.normal(0, params.range_sigma_m);
    const auto range_m = static_cast<float>(hit ? hit->range_m + noise_m : 0.0);
    const bool is_valid =
        hit && range_m >= params.range_min_m && range_m <= params.range_max_m && range_m > 0;
    scan.ranges_m.push_back(is_valid ? range_m
                                     : static_cast<float>(params.range_max_m + kNoReturnExcess_m));
    scan.is_valid.push_back(is_valid ? 1 : 0);
  }
  return scan;
}

WheelScales draw_wheel_scales(const WheelParams& params, Rng rng) {
  const double common = rng.normal(1, params.scale_sigma);
  const double unbalance = rng.normal(0, params.unbalance_sigma);
  return {common + unbalance, common - unbalance};
}

void WheelEncoders::advance(const DriveState& from, const DriveState& to, double step_s,
                            double spin_ratio) {
  const double path_m = 0.5 * (from.speed_mps + to.speed_mps) * step_s;
  const double turn_rad = 0.5 * (from.yaw_rate_radps + to.yaw_rate_radps) * step_s;
  const double half_difference_m = 0.5 * params_.track_m * turn_rad;
  const double spin = 1 + spin_ratio;
  left_path_m_ +=
      (path_m - half_difference_m) * spin * scales_.left * rng_.normal(1, params_.noise_ratio);
  right_path_m_ +=
      (path_m + half_difference_m) * spin * scales_.right * rng_.normal(1, params_.noise_ratio);
}

WheelSample WheelEncoders::sample(Timestamp stamp) {
  const WheelTicks ticks{
      .left = static_cast<std::int64_t>(std::floor(left_path_m_ / params_.m_per_tick)),
      .right = static_cast<std::int64_t>(std::floor(right_path_m_ / params_.m_per_tick))};
  const double left_m =
      static_cast<double>(ticks.left - last_.ticks->left) * nominal_.left_m_per_tick;
  const double right_m =
      static_cast<double>(ticks.right - last_.ticks->right) * nominal_.right_m_per_tick;
  last_ = {.stamp = stamp,
           .T_odom_base = last_.T_odom_base.plus(
               {0.5 * (left_m + right_m), 0, (right_m - left_m) / nominal_.track_m}),
           .ticks = ticks};
  return last_;
}

ImuBias draw_imu_bias(const ImuParams& params, Rng rng) {
  ImuBias bias;
  bias.gyro_radps = rng.normal(0, params.gyro_bias_sigma_radps);
  bias.accel_x_mps2 = rng.normal(0, params.accel_bias_sigma_mps2);
  bias.accel_y_mps2 = rng.normal(0, params.accel_bias_sigma_mps2);
  return bias;
}

ImuSample measure_imu(const DriveState& from, const DriveState& to, double step_s, Timestamp stamp,
                      const ImuBias& bias, const ImuParams& params, Rng& rng) {
  ImuSample sample;
  sample.stamp = stamp;
  sample.gyro_z_radps =
      to.yaw_rate_radps + bias.gyro_radps + rng.normal(0, params.gyro_noise_radps);
  sample.accel_x_mps2 = (to.speed_mps - from.speed_mps) / step_s + bias.accel_x_mps2 +
                        rng.normal(0, params.accel_noise_mps2);
  sample.accel_y_mps2 =
      to.speed_mps * to.yaw_rate_radps + bias.accel_y_mps2 + rng.normal(0, params.accel_noise_mps2);
  return sample;
}

}  // namespace corridor::simulation
