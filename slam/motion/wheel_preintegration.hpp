// Wheel odometry between two moments with derivatives by the wheels' calibration, as the IMU's is
// preintegrated [Forster2017, sec. VI]: a later estimate of the calibration corrects it without a
// look at the readings. First order; the model of the errors is that of [Borenstein1996].
#pragma once

#include <Eigen/Core>

#include "slam/core/pose2.hpp"

namespace corridor::motion {

// Errors of the wheels, of their clock and of their place, zero for those of the robot model.
//   scale      1      true path = (1 + scale) * path by nominal radii
//   unbalance  rad/m  turn per path that unequal radii hide
//   turn       1      true turn = (1 + turn) * turn by the nominal track, beside the unbalance
//   delay      s      the wheels' reading stamped t + delay is of the moment t
//   x, y, theta       m, rad: T_base_axle, the axle's middle in the base, as the LiDAR defines that
using WheelCalibration = Eigen::Matrix<double, 7, 1>;
enum WheelCalibrationIndex { kScale, kUnbalance, kTurn, kDelay, kAxleX, kAxleY, kAxleTheta };

// T_base_axle of a calibration.
inline Pose2 axle_of(const WheelCalibration& calibration) {
  return {calibration(kAxleX), calibration(kAxleY), calibration(kAxleTheta)};
}

// Motion of the axle from i to j.
class WheelDelta {
 public:
  using Intrinsics = Eigen::Vector4d;  // the first four of a calibration
  using ByIntrinsics = Eigen::Matrix<double, 3, 4>;

  explicit WheelDelta(const WheelCalibration& calibration = WheelCalibration::Zero())
      : intrinsics_(calibration.head<4>()) {}
  // Goes on by one step of raw odometry, short enough for its chord to be its path.
  void append(const Pose2& raw_step);
  // Goes on by another delta, of the same calibration.
  void append(const WheelDelta& next);
  // Raw motion per second (m/s, m/s, rad/s) of the axle at i and at j, in its frame there: what a
  // delay of the clock exchanges.
  void set_twists(const Eigen::Vector3d& raw_at_i, const Eigen::Vector3d& raw_at_j);

  // T_i_j at a calibration near that of the integration, to first order.
  [[nodiscard]] Pose2 at(const WheelCalibration& calibration) const;
  // The base's motion instead of the axle's.
  [[nodiscard]] Pose2 base_motion(const WheelCalibration& calibration) const {
    const Pose2 T_base_axle = axle_of(calibration);
    return T_base_axle * at(calibration) * T_base_axle.inverse();
  }
  // Derivative of (x_m, y_m, theta_rad) of T_i_j, 3x4.
  [[nodiscard]] const ByIntrinsics& by_intrinsics() const { return by_intrinsics_; }
  // As the wheels measured it, with no correction.
  [[nodiscard]] const Pose2& raw_T_i_j() const { return raw_T_i_j_; }

 private:
  [[nodiscard]] Eigen::Vector3d corrected_twist(const Eigen::Vector3d& raw) const;

  Intrinsics intrinsics_;
  Pose2 T_i_j_, raw_T_i_j_;
  ByIntrinsics by_intrinsics_ = ByIntrinsics::Zero();
};

}  // namespace corridor::motion
