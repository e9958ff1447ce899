#include "slam/fusion/calibration.hpp"

#include <algorithm>
#include <cmath>

namespace corridor::fusion {
namespace {

// Of what is not estimated, in any unit.
constexpr double kKnown = 1e-6;
// A bias always walks a little, so that the factor stays defined for ideal sensors.
constexpr double kMinBiasWalk = 1e-7;
// The gyro's scale, per root second: a hundredth of its prior in three hours.
constexpr double kGyroScaleWalk = 1e-6;

}  // namespace

motion::WheelCalibration wheel_calibration_sigma(const FusionParams& params) {
  motion::WheelCalibration sigma = motion::WheelCalibration::Constant(kKnown);
  if (params.use_wheel_scale) sigma(motion::kScale) = params.wheel_scale_sigma;
  if (params.use_wheel_turn) {
    sigma(motion::kUnbalance) = params.wheel_unbalance_sigma_radpm;
    sigma(motion::kTurn) = params.wheel_turn_sigma;
  }
  if (params.use_wheel_delay) sigma(motion::kDelay) = params.wheel_delay_sigma_s;
  if (params.use_axle_pose) {
    sigma(motion::kAxleX) = sigma(motion::kAxleY) = params.axle_position_sigma_m;
    sigma(motion::kAxleTheta) = params.axle_heading_sigma_rad;
  }
  return sigma;
}

motion::WheelCalibration wheel_calibration_walk(const FusionParams& params) {
  return (params.calibration_walk_ratio * wheel_calibration_sigma(params)).cwiseMax(kKnown);
}

motion::ImuBias imu_bias_sigma(const FusionParams& params) {
  return {params.gyro_bias_sigma_radps, params.accel_bias_sigma_mps2, params.accel_bias_sigma_mps2,
          params.use_gyro_scale ? params.gyro_scale_sigma : kKnown};
}

motion::ImuBias imu_bias_walk(const ImuModel& imu, double duration_s) {
  const double root_s = std::sqrt(duration_s);
  const double gyro = std::max(imu.gyro_bias_walk_radps_sqrt_s * root_s, kMinBiasWalk);
  const double accel = std::max(imu.accel_bias_walk_mps2_sqrt_s * root_s, kMinBiasWalk);
  return {gyro, accel, accel, std::max(kGyroScaleWalk * root_s, kMinBiasWalk)};
}

void add_next_calibration(std::uint32_t number, const motion::WheelCalibration& estimate,
                          const FusionParams& params, graph::Values& values,
                          std::vector<graph::NewFactor>& factors) {
  values.set_wheel_calibration(number + 1, estimate);
  factors.push_back(
      graph::WheelCalibrationWalk(number, number + 1, wheel_calibration_walk(params)));
  factors.push_back(
      graph::WheelCalibrationPrior(number + 1, estimate, wheel_calibration_sigma(params)));
}

bool is_wheel_calibration_estimated(const FusionParams& params) {
  return params.use_wheels && (params.use_wheel_scale || params.use_wheel_turn ||
                               params.use_wheel_delay || params.use_axle_pose);
}

}  // namespace corridor::fusion
