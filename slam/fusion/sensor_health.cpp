#include "slam/fusion/sensor_health.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace corridor::fusion {
namespace {

double square(double x) { return x * x; }

// Weight of one observation in the running mean of the wheels' normalised error.
constexpr double kAdaptationRate = 0.05;
// A single gross error counts as no more than this, so that one slip does not blind the wheels.
constexpr double kMaxSingleSquare = 100;
constexpr int kMinCommonBeams = 10;

}  // namespace

Eigen::Matrix3d WheelNoise::covariance() const {
  return Eigen::Vector3d(square(translation_sigma_m), square(translation_sigma_m),
                         square(rotation_sigma_rad))
      .asDiagonal();
}

WheelNoise nominal_wheel_noise(const Pose2& wheel_T_i_j, const WheelModel& model,
                               const FusionParams& params) {
  const double path_m = wheel_T_i_j.translation_m().norm();
  const double turn_rad = std::abs(wheel_T_i_j.theta_rad());
  const double random_m2 = square(model.sigma_m_per_sqrt_m) * (path_m + turn_rad * model.track_m);
  WheelNoise noise;
  noise.translation_sigma_m = std::sqrt(square(params.wheel_translation_floor_m) + random_m2 +
                                        square(params.wheel_translation_ratio * path_m));
  noise.rotation_sigma_rad =
      std::sqrt(square(params.wheel_rotation_floor_rad) + 2 * random_m2 / square(model.track_m) +
                square(params.wheel_rotation_per_m_rad * path_m) +
                square(params.wheel_rotation_ratio * turn_rad));
  return noise;
}

double adaptive_factor(double measure_over_threshold) { return 1 + square(measure_over_threshold); }

std::optional<double> mean_range_difference_m(const LaserScan& earlier, const LaserScan& later,
                                              double turn_rad) {
  if (earlier.num_beams() != later.num_beams() || later.angle_increment_rad == 0) {
    return std::nullopt;
  }
  const auto n = static_cast<int>(later.num_beams());
  const int shift = static_cast<int>(std::lround(turn_rad / later.angle_increment_rad));
  const bool is_full_circle = std::abs(n * later.angle_increment_rad) > 2 * std::numbers::pi - 1e-3;
  double sum = 0;
  int count = 0;
  for (int i = 0; i < n; ++i) {
    // A surface at beam i now was at beam i + shift before the robot turned by +turn.
    int j = i + shift;
    if (is_full_circle) j = ((j % n) + n) % n;
    if (j < 0 || j >= n) continue;
    const auto a = static_cast<std::size_t>(j);
    const auto b = static_cast<std::size_t>(i);
    if (!earlier.is_valid[a] || !later.is_valid[b]) continue;
    sum +=
        std::abs(static_cast<double>(earlier.ranges_m[a]) - static_cast<double>(later.ranges_m[b]));
    ++count;
  }
  if (count < kMinCommonBeams) return std::nullopt;
  return sum / count;
}

double range_difference_floor_m(double range_sigma_m) {
  return 2 * range_sigma_m / std::sqrt(std::numbers::pi);
}

double velocity_variance_m2ps2(double velocity_sigma_mps, double anchor_age_s,
                               const ImuModel& imu_model, const FusionParams& params) {
  const double walk_mps2_sqrt_s = imu_model.accel_noise_mps2 / std::sqrt(imu_model.rate_hz);
  const double bias_error_mps2 = 0.1 * params.accel_bias_sigma_mps2;
  return square(velocity_sigma_mps) + square(walk_mps2_sqrt_s) * anchor_age_s +
         square(bias_error_mps2 * anchor_age_s);
}

SlipTest test_slip(const Pose2& scaled_wheel_T_i_j, const WheelNoise& noise,
                   const motion::ImuDelta& imu, const Eigen::Vector2d& velocity_base_mps,
                   double velocity_sigma_mps, double anchor_age_s, const ImuModel& imu_model,
                   const FusionParams& params) {
  const double dt = imu.duration_s;
  const Eigen::Vector2d difference =
      velocity_base_mps * dt + imu.position_m - scaled_wheel_T_i_j.translation_m();
  SlipTest test;
  if (!params.use_statistical_slip_test) {
    test.measure_over_threshold = difference.norm() / params.slip_threshold_m;
    test.is_slip = test.measure_over_threshold > 1;
    return test;
  }
  const double velocity_variance =
      velocity_variance_m2ps2(velocity_sigma_mps, anchor_age_s, imu_model, params);
  const double variance = square(noise.translation_sigma_m) + velocity_variance * dt * dt;
  const Eigen::Matrix2d covariance =
      imu.covariance.bottomRightCorner<2, 2>() + variance * Eigen::Matrix2d::Identity();
  test.measure_over_threshold =
      difference.dot(covariance.llt().solve(difference)) / params.slip_gate;
  test.is_slip = test.measure_over_threshold > 1;
  return test;
}

void WheelNoiseAdapter::observe(double normalized_square) {
  const double limited = std::min(normalized_square, kMaxSingleSquare) * square(factor());
  mean_square_ += kAdaptationRate * (limited - mean_square_);
}

double WheelNoiseAdapter::factor() const {
  return std::clamp(std::sqrt(mean_square_), 1.0, max_factor_);
}

}  // namespace corridor::fusion
