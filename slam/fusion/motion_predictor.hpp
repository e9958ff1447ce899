// Caches wheels and IMU and tells how the robot moved between two scans: translation from the
// wheels (with their estimated calibration), rotation from the bias-corrected gyro. Where the
// wheels are silent the IMU carries the estimated velocity on, where both are, the last motion goes
// on.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "slam/core/imu.hpp"
#include "slam/core/robot_model.hpp"
#include "slam/core/wheel.hpp"
#include "slam/fusion/fusion_params.hpp"
#include "slam/motion/imu_track.hpp"
#include "slam/motion/wheel_track.hpp"

namespace corridor::fusion {

struct MotionEstimate {
  Pose2 T_last_now;
  Eigen::Matrix3d covariance;  // 3x3, order (x_m, y_m, theta_rad), base now
};

struct Prediction {
  Pose2 T_last_now;  // motion of the base since the last scan
  Eigen::Matrix3d covariance =
      Eigen::Matrix3d::Zero();  // 3x3, order (x_m, y_m, theta_rad), base now
  bool has_wheels = false;
  bool is_turn_by_gyro = false;
  // The same motion by the wheels alone, turn included, and by the IMU alone, from the estimated
  // velocity on: no reading since the last scan is in both. The second is unknown while the
  // velocity is, and where a part of the motion went by without a reading.
  std::optional<MotionEstimate> by_wheels, by_imu;
};

// What the estimator knows when it asks for a prediction.
struct MotionState {
  double wheel_noise_factor = 1;  // on the wheels' standard deviations
  // Of the base where the key interval began, in the base frame there; none while unknown.
  std::optional<Eigen::Vector2d> velocity_mps;
  double velocity_variance_m2ps2 = 0;  // of each component
  // Mean motion between the last two scans per second, (m/s, m/s, rad/s), base frame.
  Eigen::Vector3d twist = Eigen::Vector3d::Zero();
};

class MotionPredictor {
 public:
  MotionPredictor(const RobotModel& robot, const FusionParams& params);

  void add(const WheelSample& sample) { wheels_.add(sample); }
  void add(const ImuSample& sample) { imu_.add(sample); }

  [[nodiscard]] bool has_reading() const { return imu_.has_reading(); }
  // The IMU is used from the first key interval on that began with a reading.
  [[nodiscard]] bool has_imu() const { return is_imu_in_use_; }
  // Motion since the last call; integrates the IMU up to the stamp.
  Prediction predict(Timestamp stamp, const MotionState& state);
  // Starts a new key interval at `stamp`, that of the last predict(), with these biases and this
  // calibration of the wheels.
  void reset_interval(Timestamp stamp, const motion::ImuBias& bias,
                      const motion::WheelCalibration& calibration);
  // The IMU since reset_interval; nullopt without IMU or when nothing was integrated.
  [[nodiscard]] std::optional<motion::ImuDelta> imu_interval() const;
  // The wheels since reset_interval; nullopt where they did not know its begin or its end.
  [[nodiscard]] std::optional<motion::WheelDelta> wheel_interval() const;

 private:
  // What the wheels say of the time since they were last known; goes on with the interval.
  std::optional<motion::WheelDelta> advance_wheels(Timestamp stamp);
  // No part of the motion since the last call went by without a reading.
  [[nodiscard]] bool is_gyro_whole() const {
    return imu_.delta().unmeasured_s == last_imu_delta_.unmeasured_s;
  }
  [[nodiscard]] std::optional<MotionEstimate> by_imu(Timestamp stamp,
                                                     const MotionState& state) const;
  // By IMU and velocity or by the last twist, whichever there is.
  [[nodiscard]] Pose2 motion_without_wheels(Timestamp stamp, const MotionState& state) const;
  [[nodiscard]] Pose2 imu_motion(const motion::ImuDelta& since_begin,
                                 const Eigen::Vector2d& velocity_mps) const;

  const RobotModel& robot_;
  const FusionParams& params_;
  motion::WheelTrack wheels_;
  motion::ImuTrack imu_;
  motion::WheelCalibration calibration_ = motion::WheelCalibration::Zero();
  // Of the running interval, up to the last scan at which the wheels were known.
  motion::WheelDelta wheel_delta_;
  bool did_wheels_know_begin_ = false;
  // At the last scan at which they were known, and its stamp.
  std::optional<motion::WheelReading> last_reading_;
  std::optional<Timestamp> last_wheel_stamp_;
  std::optional<Timestamp> last_stamp_;
  motion::ImuDelta last_imu_delta_;  // of the running interval, at the last scan
  bool is_imu_in_use_ = false;
};

}  // namespace corridor::fusion
