#include "slam/motion/gyro_odometry.hpp"

#include <cmath>

namespace corridor::motion {
namespace {

constexpr double kBiasSigma_radps = 0.01;  // before the first reading
// Wheels of unequal size and a track that is a little off: of their turn, per path and per turn.
// Standing still they are right, which is when the bias is learnt.
constexpr double kUnbalance_radpm = 0.02;
constexpr double kTurnError_ratio = 0.05;
// A tick more or less at both ends.
constexpr double kStandstill_rad = 1e-4;

double square(double x) { return x * x; }

}  // namespace

GyroOdometry::GyroOdometry(const RobotModel& robot)
    : wheels_(robot.wheels),
      imu_(robot.imu),
      gyro_(robot.imu),
      bias_variance_(square(kBiasSigma_radps)) {}

WheelSample GyroOdometry::corrected(const WheelSample& sample) {
  gyro_.advance_to(sample.stamp);
  WheelSample result = sample;
  if (!last_) {
    T_odom_base_ = sample.T_odom_base;
  } else {
    const Pose2 step = last_->T_odom_base.between(sample.T_odom_base);
    const double turn_rad = turn_of(step.theta_rad(), step.translation_m().norm(),
                                    seconds_between(last_->stamp, sample.stamp));
    // The chord turns by half of what the filter corrects.
    const Pose2 half(0, 0, 0.5 * (turn_rad - step.theta_rad()));
    const Eigen::Vector2d chord = half * step.translation_m();
    T_odom_base_ = T_odom_base_ * Pose2(chord.x(), chord.y(), turn_rad);
    result.T_odom_base = T_odom_base_;
  }
  gyro_.reset(ImuBias::Zero());
  last_ = sample;
  return result;
}

// The turn since the last sample: predicted by the gyro without its bias, corrected by the wheels.
// Nothing measures the heading itself, so the filter keeps of it no more than how its last turn and
// the bias depend on each other.
double GyroOdometry::turn_of(double wheel_turn_rad, double path_m, double duration_s) {
  const ImuDelta& delta = gyro_.delta();
  if (delta.unmeasured_s > 0 || delta.duration_s <= 0 || duration_s <= 0) return wheel_turn_rad;
  bias_variance_ += square(imu_.gyro_bias_walk_radps_sqrt_s) * duration_s;
  const double predicted_rad = delta.theta_rad - bias_radps_ * duration_s;
  const double gyro_variance = square(imu_.gyro_noise_radps) * duration_s / imu_.rate_hz;
  const double variance = bias_variance_ * square(duration_s) + gyro_variance;
  const double wheel_variance = 2 * square(wheels_.sigma_m_per_sqrt_m / wheels_.track_m) * path_m +
                                square(kUnbalance_radpm * path_m) +
                                square(kTurnError_ratio * wheel_turn_rad) + square(kStandstill_rad);
  const double innovation_rad = wheel_turn_rad - predicted_rad;
  const double innovation_variance = variance + wheel_variance;
  const double bias_covariance = -bias_variance_ * duration_s;
  bias_radps_ += bias_covariance / innovation_variance * innovation_rad;
  bias_variance_ -= square(bias_covariance) / innovation_variance;
  return predicted_rad + variance / innovation_variance * innovation_rad;
}

}  // namespace corridor::motion
