// Caches wheels and IMU and tells how the robot moved between two scans: translation from the
// wheels (with the estimated scale), rotation from the bias-corrected gyro, or from the wheels
// without one.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "slam/core/imu.hpp"
#include "slam/core/robot_model.hpp"
#include "slam/core/wheel.hpp"
#include "slam/fusion/fusion_params.hpp"
#include "slam/motion/imu_preintegration.hpp"
#include "slam/motion/wheel_track.hpp"

namespace corridor::fusion {

struct Prediction {
  Pose2 T_last_now;  // motion of the base since the last scan
  Eigen::Matrix3d covariance =
      Eigen::Matrix3d::Zero();  // 3x3, order (x_m, y_m, theta_rad), base now
  bool has_wheels = false;
};

class MotionPredictor {
 public:
  MotionPredictor(const RobotModel& robot, const FusionParams& params);

  void add(const WheelSample& sample) { wheels_.add(sample); }
  void add(const ImuSample& sample);

  // For a log whose IMU starts too late to be a state from the beginning.
  void ignore_imu() { is_imu_ignored_ = true; }
  [[nodiscard]] bool has_imu() const { return last_imu_.has_value(); }
  [[nodiscard]] std::optional<Pose2> wheel_pose_at(Timestamp stamp) const {
    return wheels_.pose_at(stamp);
  }
  // Motion since the last call (or reset_interval); integrates the IMU up to the stamp.
  // noise_factor multiplies the wheels' standard deviations.
  Prediction predict(Timestamp stamp, double wheel_scale, double noise_factor);
  // Starts a new key interval at `stamp` with these biases.
  void reset_interval(Timestamp stamp, const Eigen::Vector3d& bias);
  // The IMU since reset_interval; nullopt without IMU or when nothing was integrated.
  [[nodiscard]] std::optional<motion::ImuDelta> imu_interval() const;

 private:
  void integrate_until(Timestamp stamp);

  const RobotModel& robot_;
  const FusionParams& params_;
  motion::WheelTrack wheels_;
  motion::ImuPreintegrator imu_;
  std::optional<ImuSample> last_imu_;
  std::optional<Timestamp> integrated_until_;
  std::optional<Pose2> last_wheel_T_odom_base_;
  double last_imu_theta_rad_ = 0;
  bool is_imu_ignored_ = false;
};

}  // namespace corridor::fusion
