#include "datasets/simulation/wheel_model.hpp"

#include <cmath>

namespace corridor::simulation {

WheelErrors draw_wheel_errors(const WheelParams& params, const Rng& rng) {
  Rng scale = rng.stream("scale");
  Rng track = rng.stream("track");
  const double common = scale.normal(1, params.scale_sigma);
  const double unbalance = scale.normal(0, params.unbalance_sigma);
  return {common + unbalance, common - unbalance, track.normal(1, params.track_sigma)};
}

void WheelEncoders::advance(const DriveState& from, const DriveState& to, double step_s,
                            double spin_ratio) {
  const double path_m = 0.5 * (from.wheel_speed_mps + to.wheel_speed_mps) * step_s;
  const double turn_rad = 0.5 * (from.yaw_rate_radps + to.yaw_rate_radps) * step_s;
  const double half_difference_m = 0.5 * params_.track_m * errors_.track_ratio * turn_rad;
  const double spin = 1 + spin_ratio;
  const double noise_ratio = params_.step_noise_ratio(step_s);
  left_path_m_ +=
      (path_m - half_difference_m) * spin * errors_.left_scale * rng_.normal(1, noise_ratio);
  right_path_m_ +=
      (path_m + half_difference_m) * spin * errors_.right_scale * rng_.normal(1, noise_ratio);
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

}  // namespace corridor::simulation
