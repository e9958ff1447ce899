#include "slam/graph/factors/pose_factors.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace corridor::graph {
namespace {

// Eigenvalues below this share of the largest are rounding of zero.
constexpr double kZeroEigenvalueRatio = 1e-15;

// What both forms of the error need of two poses and a measurement z.
struct RelativeTerms {
  Eigen::Vector2d t_i_j;       // R_i^T (t_j - t_i)
  double cosine_ij, sine_ij;   // of R_i^T R_j
  Eigen::Vector3d components;  // of D = z^-1 * T_i_j
  double cosine_D, sine_D;
};

RelativeTerms relative_terms(const OrientedPose& i, const OrientedPose& j, const OrientedPose& z) {
  RelativeTerms terms;
  terms.t_i_j = i.turn_back(j.pose.translation_m() - i.pose.translation_m());
  terms.components.head<2>() = z.turn_back(terms.t_i_j - z.pose.translation_m());
  terms.components(2) = wrap_angle(j.pose.theta_rad() - i.pose.theta_rad() - z.pose.theta_rad());
  terms.cosine_ij = i.cosine * j.cosine + i.sine * j.sine;
  terms.sine_ij = i.cosine * j.sine - i.sine * j.cosine;
  terms.cosine_D = z.cosine * terms.cosine_ij + z.sine * terms.sine_ij;
  terms.sine_D = z.cosine * terms.sine_ij - z.sine * terms.cosine_ij;
  return terms;
}

Pose2::Tangent logarithm(const Eigen::Vector3d& components) {
  return Pose2(components(0), components(1), components(2)).log();
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

void PosePrior::residual(const Values& values, FixedVector<3>& r) const {
  r = sqrt_information_ * values.pose(keys_[0].index).minus(prior_T_map_base_);
}

void PosePrior::linearize(const Values& values, FixedVector<3>& r, FixedMatrix<3, 3>& J) const {
  const Pose2::Tangent e = values.pose(keys_[0].index).minus(prior_T_map_base_);
  r = sqrt_information_ * e;
  J = sqrt_information_ * Pose2::right_jacobian_inverse(e);
}

RelativePose::RelativePose(Key pose_i, Key pose_j, const Pose2& T_i_j,
                           const Eigen::Matrix3d& sqrt_information, RelativePoseError error)
    : keys_{pose_i, pose_j}, measured_(T_i_j), sqrt_information_(sqrt_information), error_(error) {}

void RelativePose::residual(const Values& values, FixedVector<3>& r) const {
  const RelativeTerms terms =
      relative_terms(values.oriented(keys_[0].index), values.oriented(keys_[1].index), measured_);
  r = sqrt_information_ *
      (error_ == RelativePoseError::kComponents ? terms.components : logarithm(terms.components));
}

void RelativePose::linearize(const Values& values, FixedVector<3>& r, FixedMatrix<3, 6>& J) const {
  const RelativeTerms t =
      relative_terms(values.oriented(keys_[0].index), values.oriented(keys_[1].index), measured_);
  // By a motion of j in its own frame: D * Exp(delta).
  FixedMatrix<3, 3> by_j;
  if (error_ == RelativePoseError::kComponents) {
    r = sqrt_information_ * t.components;
    by_j.col(0) = t.cosine_D * sqrt_information_.col(0) + t.sine_D * sqrt_information_.col(1);
    by_j.col(1) = t.cosine_D * sqrt_information_.col(1) - t.sine_D * sqrt_information_.col(0);
    by_j.col(2) = sqrt_information_.col(2);
  } else {
    const Pose2::Tangent e = logarithm(t.components);
    r = sqrt_information_ * e;
    by_j = sqrt_information_ * Pose2::right_jacobian_inverse(e);
  }
  // X_i * Exp(d) moves j, seen from j, by Exp(-Ad(T_i_j^-1) d): by R_ij^T (-d_xy + d_theta
  // (t_y, -t_x)) and -d_theta.
  J.col(0) = t.sine_ij * by_j.col(1) - t.cosine_ij * by_j.col(0);
  J.col(1) = -t.sine_ij * by_j.col(0) - t.cosine_ij * by_j.col(1);
  J.col(2) = t.t_i_j.x() * J.col(1) - t.t_i_j.y() * J.col(0) - by_j.col(2);
  J.rightCols<3>() = by_j;
}

}  // namespace corridor::graph
