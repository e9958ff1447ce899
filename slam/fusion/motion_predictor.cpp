#include "slam/fusion/motion_predictor.hpp"

#include <cmath>

#include "slam/fusion/sensor_health.hpp"

namespace corridor::fusion {
namespace {

// A motion between two scans that wheels and gyro did not measure may be off by this much.
constexpr double kUnknownTranslation_m = 0.2;
constexpr double kUnknownRotation_rad = 0.2;
// Error of the gyro's rotation between two scans beside its noise: bias and scale.
constexpr double kGyroFloor_rad = 5e-4;
constexpr double kGyroScaleRatio = 0.01;

double gyro_sigma_rad(double turn_rad) {
  return kGyroFloor_rad + kGyroScaleRatio * std::abs(turn_rad);
}

}  // namespace

MotionPredictor::MotionPredictor(const RobotModel& robot, const FusionParams& params)
    : robot_(robot), params_(params), imu_(robot.imu) {}

Pose2 MotionPredictor::imu_motion(const motion::ImuDelta& since_begin,
                                  const Eigen::Vector2d& velocity_mps) const {
  const Eigen::Vector2d moved = velocity_mps * since_begin.duration_s + since_begin.position_m;
  return {moved.x(), moved.y(), since_begin.theta_rad};
}

Pose2 MotionPredictor::motion_without_wheels(Timestamp stamp, const MotionState& state) const {
  if (has_imu() && state.velocity_mps && imu_.delta().unmeasured_s == 0) {
    return imu_motion(last_imu_delta_, *state.velocity_mps)
        .between(imu_motion(imu_.delta(), *state.velocity_mps));
  }
  return last_stamp_ ? Pose2::exp(state.twist * seconds_between(*last_stamp_, stamp)) : Pose2();
}

std::optional<MotionEstimate> MotionPredictor::by_imu(Timestamp stamp,
                                                      const MotionState& state) const {
  const bool is_known = has_imu() && state.velocity_mps && imu_.delta().unmeasured_s == 0;
  if (!is_known || !last_stamp_) return std::nullopt;
  const Pose2 motion = motion_without_wheels(stamp, state);
  const WheelNoise noise{
      std::sqrt(state.velocity_variance_m2ps2) * seconds_between(*last_stamp_, stamp),
      gyro_sigma_rad(motion.theta_rad())};
  return MotionEstimate{motion, noise.covariance()};
}

std::optional<motion::WheelDelta> MotionPredictor::advance_wheels(Timestamp stamp) {
  const std::optional<motion::WheelReading> now = wheels_.read(stamp, calibration_(motion::kDelay));
  if (!now) return std::nullopt;
  std::optional<motion::WheelDelta> step;
  if (last_reading_) {
    step = wheels_.between(*last_reading_, *now, calibration_);
    wheel_delta_.append(*step);
  }
  last_reading_ = now;
  last_wheel_stamp_ = stamp;
  return step;
}

Prediction MotionPredictor::predict(Timestamp stamp, const MotionState& state) {
  imu_.advance_to(stamp);
  Prediction prediction;
  const bool were_wheels_known = last_wheel_stamp_ && last_wheel_stamp_ == last_stamp_;
  const std::optional<motion::WheelDelta> step = advance_wheels(stamp);
  WheelNoise noise{kUnknownTranslation_m, kUnknownRotation_rad};
  Pose2 motion;
  if (step && were_wheels_known) {
    prediction.has_wheels = true;
    noise = nominal_wheel_noise(step->raw_T_i_j(), robot_.wheels, params_);
    noise.translation_sigma_m *= state.wheel_noise_factor;
    noise.rotation_sigma_rad *= state.wheel_noise_factor;
    motion = step->base_motion(calibration_);
    prediction.by_wheels = MotionEstimate{motion, noise.covariance()};
  } else {
    motion = motion_without_wheels(stamp, state);
  }
  if (has_imu() && is_gyro_whole()) {
    prediction.is_turn_by_gyro = true;
    const double turn_rad = imu_.delta().theta_rad - last_imu_delta_.theta_rad;
    noise.rotation_sigma_rad = gyro_sigma_rad(turn_rad);
    motion = {motion.x_m(), motion.y_m(), turn_rad};
  }
  prediction.by_imu = by_imu(stamp, state);
  last_imu_delta_ = imu_.delta();
  last_stamp_ = stamp;
  prediction.T_last_now = motion;
  prediction.covariance = noise.covariance();
  return prediction;
}

void MotionPredictor::reset_interval(Timestamp stamp, const motion::ImuBias& bias,
                                     const motion::WheelCalibration& calibration) {
  is_imu_in_use_ = imu_.has_reading();
  imu_.advance_to(stamp);
  imu_.reset(bias);
  last_imu_delta_ = imu_.delta();
  calibration_ = calibration;
  wheel_delta_ = motion::WheelDelta(calibration);
  did_wheels_know_begin_ = last_wheel_stamp_ == stamp;
  // What the new delay moves was read from the same samples: it is no motion of the robot.
  if (did_wheels_know_begin_) last_reading_ = wheels_.read(stamp, calibration(motion::kDelay));
}

std::optional<motion::WheelDelta> MotionPredictor::wheel_interval() const {
  if (!did_wheels_know_begin_ || last_wheel_stamp_ != last_stamp_) return std::nullopt;
  return wheel_delta_;
}

std::optional<motion::ImuDelta> MotionPredictor::imu_interval() const {
  if (!has_imu() || imu_.delta().duration_s <= 0) return std::nullopt;
  return imu_.delta();
}

}  // namespace corridor::fusion
