// Planar IMU preintegration on the manifold with bias Jacobians and covariance.
// [Forster2017] eq. 35-38 (measurement), 44 (bias correction), A.9 (covariance), reduced to SE(2);
// gravity drops out on a level floor. It does not estimate anything.
#pragma once

#include <Eigen/Core>

#include "slam/core/imu.hpp"
#include "slam/core/robot_model.hpp"

namespace corridor::motion {

// What an IMU adds to the truth, and how its gyro stretches it; order (gyro z [rad/s],
// accelerometer x, y [m/s^2], gyro scale error [1]): true rate = (1 + scale error) * (reading -
// bias).
using ImuBias = Eigen::Vector4d;

// Motion of the base between two moments, seen in the base frame of the first, without its initial
// velocity.
struct ImuDelta {
  double duration_s = 0;
  double unmeasured_s = 0;  // part of it in which readings were missing
  double theta_rad = 0;
  Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  ImuBias bias = ImuBias::Zero();  // at which the above were integrated
  // Derivatives by the bias: theta 1x4, velocity 2x4, position 2x4.
  Eigen::RowVector4d theta_by_bias = Eigen::RowVector4d::Zero();
  Eigen::Matrix<double, 2, 4> velocity_by_bias = Eigen::Matrix<double, 2, 4>::Zero();
  Eigen::Matrix<double, 2, 4> position_by_bias = Eigen::Matrix<double, 2, 4>::Zero();
  // 5x5, order (theta_rad, velocity_mps x y, position_m x y), in the first base frame.
  Eigen::Matrix<double, 5, 5> covariance = Eigen::Matrix<double, 5, 5>::Zero();

  // First-order correction to another bias, [Forster2017] eq. 44.
  [[nodiscard]] ImuDelta corrected(const ImuBias& other_bias) const;
};

class ImuPreintegrator {
 public:
  ImuPreintegrator(const ImuModel& model, const ImuBias& bias);

  // Holds one reading for `duration_s` > 0. Rate and force turn into the base frame; the
  // centripetal part of the lever arm is taken out, its Euler part (angular acceleration) is not.
  void integrate(const ImuSample& sample, double duration_s);
  // Carries heading and velocity on through a time without readings, > 0, and widens the covariance
  // by the motion that may have gone unseen.
  void coast(double duration_s);
  void reset(const ImuBias& bias);
  [[nodiscard]] const ImuDelta& delta() const { return delta_; }

 private:
  ImuModel model_;
  ImuDelta delta_;
};

}  // namespace corridor::motion
