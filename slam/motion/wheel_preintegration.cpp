#include "slam/motion/wheel_preintegration.hpp"

#include <cmath>

namespace corridor::motion {

void WheelDelta::append(const Pose2& raw_step) {
  raw_T_i_j_ = raw_T_i_j_ * raw_step;
  const double turn = raw_step.theta_rad();
  const double path = std::copysign(raw_step.translation_m().norm(), raw_step.x_m());
  const double hidden = intrinsics_(kUnbalance) * path + intrinsics_(kTurn) * turn;
  // The chord points half way between the headings at its ends.
  const Pose2 chord(0, 0, T_i_j_.theta_rad() + 0.5 * hidden);
  const Eigen::Vector2d raw = chord.rotation() * raw_step.translation_m();
  const Eigen::Vector2d moved = (1 + intrinsics_(kScale)) * raw;
  const Eigen::RowVector4d hidden_by(0, path, turn, 0);
  by_intrinsics_.topRows<2>() += perpendicular(moved) * (by_intrinsics_.row(2) + 0.5 * hidden_by);
  by_intrinsics_.topLeftCorner<2, 1>() += raw;
  by_intrinsics_.row(2) += hidden_by;
  const Eigen::Vector2d t = T_i_j_.translation_m() + moved;
  T_i_j_ = {t.x(), t.y(), T_i_j_.theta_rad() + turn + hidden};
}

void WheelDelta::append(const WheelDelta& next) {
  const Eigen::Matrix2d R = T_i_j_.rotation();
  const Eigen::Vector2d moved = R * next.T_i_j_.translation_m();
  by_intrinsics_.topRows<2>() +=
      perpendicular(moved) * by_intrinsics_.row(2) + R * next.by_intrinsics_.topRows<2>();
  by_intrinsics_.row(2) += next.by_intrinsics_.row(2);
  T_i_j_ = T_i_j_ * next.T_i_j_;
  raw_T_i_j_ = raw_T_i_j_ * next.raw_T_i_j_;
}

Eigen::Vector3d WheelDelta::corrected_twist(const Eigen::Vector3d& raw) const {
  const double speed_mps = std::copysign(raw.head<2>().norm(), raw.x());
  const double scale = 1 + intrinsics_(kScale);
  return {scale * raw.x(), scale * raw.y(),
          (1 + intrinsics_(kTurn)) * raw.z() + intrinsics_(kUnbalance) * speed_mps};
}

void WheelDelta::set_twists(const Eigen::Vector3d& raw_at_i, const Eigen::Vector3d& raw_at_j) {
  const Eigen::Vector3d at_i = corrected_twist(raw_at_i);
  const Eigen::Vector3d at_j = corrected_twist(raw_at_j);
  by_intrinsics_.col(kDelay).head<2>() = T_i_j_.rotation() * at_j.head<2>() - at_i.head<2>() -
                                         at_i(2) * perpendicular(T_i_j_.translation_m());
  by_intrinsics_(2, kDelay) = at_j(2) - at_i(2);
}

Pose2 WheelDelta::at(const WheelCalibration& calibration) const {
  const Eigen::Vector3d change = by_intrinsics_ * (calibration.head<4>() - intrinsics_);
  return {T_i_j_.x_m() + change(0), T_i_j_.y_m() + change(1), T_i_j_.theta_rad() + change(2)};
}

}  // namespace corridor::motion
