#include "slam/fusion/motion_predictor.hpp"

#include "slam/fusion/sensor_health.hpp"

namespace corridor::fusion {
namespace {

// Without wheels nothing is known of the translation between two scans but that it is short.
constexpr double kUnknownTranslation_m = 0.2;
constexpr double kUnknownRotation_rad = 0.2;
// Error of the gyro's rotation between two scans beside its noise: bias and scale.
// A reading stands for no longer than this; beyond it the motion went unmeasured.
constexpr double kMaxHold_s = 0.3;
constexpr double kGyroFloor_rad = 5e-4;
constexpr double kGyroScaleRatio = 0.01;

}  // namespace

MotionPredictor::MotionPredictor(const RobotModel& robot, const FusionParams& params)
    : robot_(robot), params_(params), imu_(robot.imu, Eigen::Vector3d::Zero()) {}

void MotionPredictor::integrate_until(Timestamp stamp) {
  if (!last_imu_) return;
  const double duration_s = integrated_until_ ? seconds_between(*integrated_until_, stamp) : 0;
  if (duration_s > 0) imu_.integrate(*last_imu_, duration_s);
  if (duration_s > kMaxHold_s) imu_.add_unmeasured_time(duration_s);
  if (!integrated_until_ || duration_s > 0) integrated_until_ = stamp;
}

void MotionPredictor::add(const ImuSample& sample) {
  if (is_imu_ignored_) return;
  // A reading stands for the time since the one before it.
  last_imu_ = sample;
  integrate_until(sample.stamp);
}

Prediction MotionPredictor::predict(Timestamp stamp, double wheel_scale, double noise_factor) {
  integrate_until(stamp);
  Prediction prediction;
  const std::optional<Pose2> wheel_pose = wheels_.pose_at(stamp);
  Pose2 wheel_motion;
  WheelNoise noise{kUnknownTranslation_m, kUnknownRotation_rad};
  if (wheel_pose && last_wheel_T_odom_base_) {
    prediction.has_wheels = true;
    wheel_motion = last_wheel_T_odom_base_->between(*wheel_pose);
    noise = nominal_wheel_noise(wheel_motion, robot_.wheels, params_);
    noise.translation_sigma_m *= noise_factor;
    noise.rotation_sigma_rad *= noise_factor;
  }
  double turn_rad = wheel_motion.theta_rad();
  const bool is_gyro_whole = imu_.delta().unmeasured_s == 0;
  if (has_imu() && (is_gyro_whole || !prediction.has_wheels)) {
    turn_rad = imu_.delta().theta_rad - last_imu_theta_rad_;
    noise.rotation_sigma_rad = kGyroFloor_rad + kGyroScaleRatio * std::abs(turn_rad) +
                               (is_gyro_whole ? 0 : kUnknownRotation_rad);
  }
  last_imu_theta_rad_ = imu_.delta().theta_rad;
  last_wheel_T_odom_base_ = wheel_pose;
  prediction.T_last_now = Pose2((1 + wheel_scale) * wheel_motion.x_m(),
                                (1 + wheel_scale) * wheel_motion.y_m(), turn_rad);
  prediction.covariance = noise.covariance();
  return prediction;
}

void MotionPredictor::reset_interval(Timestamp stamp, const Eigen::Vector3d& bias) {
  integrate_until(stamp);
  imu_.reset(bias);
  last_imu_theta_rad_ = 0;
}

std::optional<motion::ImuDelta> MotionPredictor::imu_interval() const {
  if (!has_imu() || imu_.delta().duration_s <= 0) return std::nullopt;
  return imu_.delta();
}

}  // namespace corridor::fusion
