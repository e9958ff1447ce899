#include "slam/graph/factors/pose_factors.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace corridor::graph {
namespace {

// Eigenvalues below this share of the largest are rounding of zero.
constexpr double kZeroEigenvalueRatio = 1e-15;

// d components(D * Exp(delta)) / d delta: the translation turns with D, the angle adds.
Eigen::Matrix3d component_jacobian(const Pose2& D) {
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Identity();
  jacobian.topLeftCorner<2, 2>() = D.rotation();
  return jacobian;
}

}  // namespace

Eigen::Matrix3d square_root_information(const Eigen::Matrix3d& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  const double largest = eigen.eigenvalues().maxCoeff();
  Eigen::Matrix3d square_root = eigen.eigenvectors().transpose();
  for (int i = 0; i < 3; ++i) {
    const double lambda = eigen.eigenvalues()(i);
    square_root.row(i) *= lambda > kZeroEigenvalueRatio * largest ? std::sqrt(lambda) : 0.0;
  }
  return square_root;
}

PosePrior::PosePrior(Key pose, const Pose2& prior_T_map_base,
                     const Eigen::Matrix3d& sqrt_information)
    : keys_{pose}, prior_T_map_base_(prior_T_map_base), sqrt_information_(sqrt_information) {}

void PosePrior::residual(const Values& values, Eigen::Ref<Eigen::VectorXd> residual) const {
  residual = sqrt_information_ * values.pose(keys_[0].index).minus(prior_T_map_base_);
}

void PosePrior::linearize(const Values& values, Eigen::Ref<Eigen::VectorXd> residual,
                          Eigen::Ref<Eigen::MatrixXd> jacobian) const {
  const Pose2::Tangent e = values.pose(keys_[0].index).minus(prior_T_map_base_);
  residual = sqrt_information_ * e;
  jacobian = sqrt_information_ * Pose2::right_jacobian_inverse(e);
}

RelativePose::RelativePose(Key pose_i, Key pose_j, const Pose2& T_i_j,
                           const Eigen::Matrix3d& sqrt_information, RelativePoseError error)
    : keys_{pose_i, pose_j}, T_i_j_(T_i_j), sqrt_information_(sqrt_information), error_(error) {}

Eigen::Vector3d RelativePose::error(const Values& values) const {
  const Pose2 D = T_i_j_.between(values.pose(keys_[0].index).between(values.pose(keys_[1].index)));
  if (error_ == RelativePoseError::kLogarithm) return D.log();
  return {D.x_m(), D.y_m(), D.theta_rad()};
}

void RelativePose::residual(const Values& values, Eigen::Ref<Eigen::VectorXd> residual) const {
  residual = sqrt_information_ * error(values);
}

void RelativePose::linearize(const Values& values, Eigen::Ref<Eigen::VectorXd> residual,
                             Eigen::Ref<Eigen::MatrixXd> jacobian) const {
  const Pose2 T_i_j = values.pose(keys_[0].index).between(values.pose(keys_[1].index));
  const Pose2 D = T_i_j_.between(T_i_j);
  const Eigen::Vector3d e = error_ == RelativePoseError::kLogarithm
                                ? Eigen::Vector3d(D.log())
                                : Eigen::Vector3d(D.x_m(), D.y_m(), D.theta_rad());
  const Eigen::Matrix3d de_dj = error_ == RelativePoseError::kLogarithm
                                    ? Pose2::right_jacobian_inverse(e)
                                    : component_jacobian(D);
  residual = sqrt_information_ * e;
  // X_i * Exp(d) moves j, seen from i, by Exp(-Ad(T_j_i) d).
  jacobian.leftCols<3>() = -sqrt_information_ * de_dj * T_i_j.inverse().adjoint();
  jacobian.rightCols<3>() = sqrt_information_ * de_dj;
}

}  // namespace corridor::graph
