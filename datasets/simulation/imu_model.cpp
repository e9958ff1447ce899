#include "datasets/simulation/imu_model.hpp"

#include <cmath>

#include "slam/core/units.hpp"

namespace corridor::simulation {

ImuErrors draw_imu_errors(const ImuParams& params, const Rng& rng) {
  Rng bias = rng.stream("bias");
  Rng scale = rng.stream("scale");
  ImuErrors errors;
  errors.gyro_bias_radps = bias.normal(0, params.gyro_bias_sigma_radps);
  errors.accel_bias_x_mps2 = bias.normal(0, params.accel_bias_sigma_mps2);
  errors.accel_bias_y_mps2 = bias.normal(0, params.accel_bias_sigma_mps2);
  errors.gyro_scale = scale.normal(1, params.gyro_scale_sigma);
  errors.accel_scale_x = scale.normal(1, params.accel_scale_sigma);
  errors.accel_scale_y = scale.normal(1, params.accel_scale_sigma);
  errors.misalignment_rad = scale.normal(0, params.misalignment_sigma_deg * kRadPerDeg);
  return errors;
}

FloorTilt::FloorTilt(const ImuParams& params, Rng rng)
    : sigma_rad_(params.tilt_sigma_deg * kRadPerDeg),
      length_m_(params.tilt_length_m),
      rng_(rng),
      tilt_rad_(rng_.normal(0, sigma_rad_), rng_.normal(0, sigma_rad_)) {}

Eigen::Vector2d FloorTilt::advance(double path_m) {
  if (sigma_rad_ == 0) return Eigen::Vector2d::Zero();
  const double decay = std::exp(-std::abs(path_m) / length_m_);
  const double driven_rad = sigma_rad_ * std::sqrt(1 - decay * decay);
  const double x_slope_change_rad = rng_.normal(0, driven_rad);
  const double y_slope_change_rad = rng_.normal(0, driven_rad);
  tilt_rad_ = decay * tilt_rad_ + Eigen::Vector2d(x_slope_change_rad, y_slope_change_rad);
  return kGravity_mps2 * Eigen::Vector2d(std::sin(tilt_rad_.x()), std::sin(tilt_rad_.y()));
}

ImuModel2d::ImuModel2d(const ImuParams& params, const ImuErrors& errors, double step_s,
                       const Rng& rng)
    : params_(params),
      errors_(errors),
      step_s_(step_s),
      T_base_imu_(params.x_m, params.y_m, params.yaw_deg * kRadPerDeg + errors.misalignment_rad),
      gyro_drift_(params.gyro_instability_radps, params.gyro_walk_radps_rts, step_s,
                  rng.stream("gyro drift")),
      accel_x_drift_(params.accel_instability_mps2, params.accel_walk_mps2_rts, step_s,
                     rng.stream("accel x drift")),
      accel_y_drift_(params.accel_instability_mps2, params.accel_walk_mps2_rts, step_s,
                     rng.stream("accel y drift")),
      tilt_(params, rng.stream("tilt")),
      noise_(rng.stream("noise")),
      vibration_(rng.stream("vibration")) {}

ImuSample ImuModel2d::measure(const DriveState& from, const DriveState& to, Timestamp stamp) {
  const double rate = to.yaw_rate_radps;
  const double angular_acceleration = (to.yaw_rate_radps - from.yaw_rate_radps) / step_s_;
  const Eigen::Vector2d lever_m = T_base_imu_.translation_m();
  Eigen::Vector2d force((to.speed_mps - from.speed_mps) / step_s_, to.speed_mps * rate);
  force += angular_acceleration * perpendicular(lever_m) - rate * rate * lever_m;
  const Eigen::Vector2d leaked = to.T_world_base.rotation().transpose() *
                                 tilt_.advance(0.5 * (from.speed_mps + to.speed_mps) * step_s_);
  force += leaked;
  const double shake_mps2 = params_.vibration_mps2 * std::abs(to.speed_mps);
  const double shake_x = vibration_.normal(0, shake_mps2);
  const double shake_y = vibration_.normal(0, shake_mps2);
  force += Eigen::Vector2d(shake_x, shake_y);
  force = T_base_imu_.rotation().transpose() * force;
  const Eigen::Vector2d leaked_imu = T_base_imu_.rotation().transpose() * leaked;
  bias_.gyro_radps = gyro_drift_.advance();
  bias_.accel_x_mps2 = accel_x_drift_.advance();
  bias_.accel_y_mps2 = accel_y_drift_.advance();

  ImuSample sample;
  sample.stamp = stamp;
  sample.gyro_z_radps = errors_.gyro_scale * rate + errors_.gyro_bias_radps + bias_.gyro_radps +
                        noise_.normal(0, params_.gyro_noise_radps());
  sample.accel_x_mps2 = errors_.accel_scale_x * force.x() + errors_.accel_bias_x_mps2 +
                        bias_.accel_x_mps2 + noise_.normal(0, params_.accel_noise_mps2());
  sample.accel_y_mps2 = errors_.accel_scale_y * force.y() + errors_.accel_bias_y_mps2 +
                        bias_.accel_y_mps2 + noise_.normal(0, params_.accel_noise_mps2());
  bias_.gyro_radps += errors_.gyro_bias_radps;
  bias_.accel_x_mps2 += errors_.accel_bias_x_mps2 + errors_.accel_scale_x * leaked_imu.x();
  bias_.accel_y_mps2 += errors_.accel_bias_y_mps2 + errors_.accel_scale_y * leaked_imu.y();
  return sample;
}

bool ImuModel2d::has_varying_bias() const {
  return params_.gyro_instability_radps > 0 || params_.accel_instability_mps2 > 0 ||
         params_.gyro_walk_radps_rts > 0 || params_.accel_walk_mps2_rts > 0 ||
         params_.tilt_sigma_deg > 0;
}

}  // namespace corridor::simulation
