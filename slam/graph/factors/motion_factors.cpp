#include "slam/graph/factors/motion_factors.hpp"

#include <Eigen/Cholesky>

#include "slam/core/expect.hpp"

namespace corridor::graph {
namespace {

// Order (rad, m/s, m/s, m, m).
const Eigen::Matrix<double, 5, 1> kImuFloor =
    (Eigen::Matrix<double, 5, 1>() << 1e-5, 1e-4, 1e-4, 1e-5, 1e-5).finished();

// U with U^T U = covariance^-1.
Eigen::Matrix<double, 5, 5> whitener(const Eigen::Matrix<double, 5, 5>& covariance) {
  // Ideal sensors and a single reading leave directions without noise: no measurement is that good.
  Eigen::Matrix<double, 5, 5> floored = covariance;
  floored.diagonal() += kImuFloor.cwiseAbs2();
  const Eigen::LLT<Eigen::Matrix<double, 5, 5>> llt(floored);
  CORRIDOR_EXPECT(llt.info() == Eigen::Success);
  return llt.matrixL().solve(Eigen::Matrix<double, 5, 5>::Identity());
}

struct ImuTerms {
  Eigen::Matrix2d R_i_transposed;
  Eigen::Vector2d velocity_change;  // R_i^T (v_j - v_i)
  Eigen::Vector2d displacement;     // R_i^T (p_j - p_i - v_i dt)
  Eigen::Matrix<double, 5, 1> error;
};

ImuTerms imu_terms(const std::array<Key, 5>& keys, const motion::ImuDelta& delta,
                   const Values& values) {
  const OrientedPose& pose_i = values.oriented(keys[0].index);
  const Eigen::Vector2d& velocity_i = values.velocity(keys[1].index);
  const motion::ImuDelta d = delta.corrected(values.bias(keys[2].index));
  const Pose2& pose_j = values.pose(keys[3].index);
  ImuTerms terms;
  terms.R_i_transposed = pose_i.rotation().transpose();
  terms.velocity_change = terms.R_i_transposed * (values.velocity(keys[4].index) - velocity_i);
  terms.displacement =
      terms.R_i_transposed *
      (pose_j.translation_m() - pose_i.pose.translation_m() - velocity_i * d.duration_s);
  terms.error(0) = wrap_angle(pose_j.theta_rad() - pose_i.pose.theta_rad() - d.theta_rad);
  terms.error.segment<2>(1) = terms.velocity_change - d.velocity_mps;
  terms.error.segment<2>(3) = terms.displacement - d.position_m;
  return terms;
}

Eigen::Vector3d wheel_error(const Pose2& T_i_j, const motion::WheelDelta& delta,
                            const motion::WheelCalibration& calibration) {
  const Pose2 T_base_axle = motion::axle_of(calibration);
  const Pose2 moved = T_base_axle.inverse() * T_i_j * T_base_axle;
  const Pose2 measured = delta.at(calibration);
  Eigen::Vector3d error;
  error.head<2>() = moved.translation_m() - measured.translation_m();
  error(2) = wrap_angle(T_i_j.theta_rad() - measured.theta_rad());
  return error;
}

}  // namespace

ImuMotion::ImuMotion(std::uint32_t i, std::uint32_t j, const motion::ImuDelta& delta)
    : keys_{pose_key(i), velocity_key(i), bias_key(i), pose_key(j), velocity_key(j)},
      delta_(delta),
      sqrt_information_(whitener(delta.covariance)) {}

void ImuMotion::residual(const Values& values, FixedVector<5>& r) const {
  r = sqrt_information_ * imu_terms(keys_, delta_, values).error;
}

void ImuMotion::linearize(const Values& values, FixedVector<5>& r, FixedMatrix<5, 14>& J) const {
  const ImuTerms t = imu_terms(keys_, delta_, values);
  const Eigen::Matrix2d R_i_j = t.R_i_transposed * values.oriented(keys_[3].index).rotation();
  J.setZero();
  // Columns: pose i 0-2, velocity i 3-4, bias i 5-8, pose j 9-11, velocity j 12-13.
  J(0, 2) = -1;
  J.block<2, 1>(1, 2) = -perpendicular(t.velocity_change);
  J.block<2, 1>(3, 2) = -perpendicular(t.displacement);
  J.block<2, 2>(3, 0) = -Eigen::Matrix2d::Identity();
  J.block<2, 2>(1, 3) = -t.R_i_transposed;
  J.block<2, 2>(3, 3) = -t.R_i_transposed * delta_.duration_s;
  J.block<1, 4>(0, 5) = -delta_.theta_by_bias;
  J.block<2, 4>(1, 5) = -delta_.velocity_by_bias;
  J.block<2, 4>(3, 5) = -delta_.position_by_bias;
  J(0, 11) = 1;
  J.block<2, 2>(3, 9) = R_i_j;
  J.block<2, 2>(1, 12) = t.R_i_transposed;
  r = sqrt_information_ * t.error;
  J = sqrt_information_ * J;
}

WheelMotion::WheelMotion(Key pose_i, Key pose_j, Key calibration, const motion::WheelDelta& delta,
                         const Eigen::Matrix3d& sqrt_information)
    : keys_{pose_i, pose_j, calibration}, delta_(delta), sqrt_information_(sqrt_information) {}

void WheelMotion::residual(const Values& values, FixedVector<3>& r) const {
  const Pose2 T_i_j = values.pose(keys_[0].index).between(values.pose(keys_[1].index));
  r = sqrt_information_ * wheel_error(T_i_j, delta_, values.wheel_calibration(keys_[2].index));
}

void WheelMotion::linearize(const Values& values, FixedVector<3>& r, FixedMatrix<3, 13>& J) const {
  const Pose2 T_i_j = values.pose(keys_[0].index).between(values.pose(keys_[1].index));
  const motion::WheelCalibration& calibration = values.wheel_calibration(keys_[2].index);
  const Pose2 T_base_axle = motion::axle_of(calibration);
  const Eigen::Matrix2d R_axle_base = T_base_axle.rotation().transpose();
  const Eigen::Matrix2d R_i_j = T_i_j.rotation();
  // The axle's middle, seen from base j and turned as base i.
  const Eigen::Vector2d lever = R_i_j * T_base_axle.translation_m();
  const Eigen::Vector2d moved =
      R_axle_base * (T_i_j.translation_m() + lever - T_base_axle.translation_m());
  J.setZero();
  // Columns: pose i 0-2, pose j 3-5, calibration 6-12.
  J.block<2, 2>(0, 0) = -R_axle_base;
  J.block<2, 1>(0, 2) = -R_axle_base * perpendicular(T_i_j.translation_m() + lever);
  J(2, 2) = -1;
  J.block<2, 2>(0, 3) = R_axle_base * R_i_j;
  J.block<2, 1>(0, 5) = R_axle_base * perpendicular(lever);
  J(2, 5) = 1;
  J.block<3, 4>(0, 6) = -delta_.by_intrinsics();
  J.block<2, 2>(0, 6 + motion::kAxleX) = R_axle_base * (R_i_j - Eigen::Matrix2d::Identity());
  J.block<2, 1>(0, 6 + motion::kAxleTheta) = -perpendicular(moved);
  r = sqrt_information_ * wheel_error(T_i_j, delta_, calibration);
  J = sqrt_information_ * J;
}

}  // namespace corridor::graph
