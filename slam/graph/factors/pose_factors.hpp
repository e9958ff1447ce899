// Factors on planar poses: prior, relative pose, and relative pose in some directions only.
// Error of a relative pose [Konolige2010] eq. 2, with the group's logarithm instead of the
// component difference: e = Log(z^-1 * (T_map_i^-1 * T_map_j)) = Log(Z_j_j'), in the frame of the
// measured j. RelativePoseError::kComponents gives the form of g2o instead: e = (R_z^T (R_i^T (t_j
// - t_i) - z_t), wrap(theta_j - theta_i - theta_z)); both agree to first order and are zero at the
// same poses.
#pragma once

#include <Eigen/Core>
#include <array>

#include "slam/graph/factor.hpp"

namespace corridor::graph {

// U with U^T U = information for a positive semi-definite 3x3 matrix: row i = sqrt(lambda_i) v_i^T
// of its eigen-decomposition. Rows of zeros (lambda_i <= 1e-15 of the largest) stand for
// unconstrained directions.
Eigen::Matrix3d square_root_information(const Eigen::Matrix3d& information);

// e = Log(prior^-1 * T_map_base), tangent order (x_m, y_m, theta_rad).
class PosePrior final : public Factor {
 public:
  // sqrt_information: 3x3 U with U^T U = information in base.
  PosePrior(Key pose, const Pose2& prior_T_map_base, const Eigen::Matrix3d& sqrt_information);

  [[nodiscard]] std::string_view type() const override { return "pose_prior"; }
  [[nodiscard]] std::span<const Key> keys() const override { return keys_; }
  [[nodiscard]] int dimension() const override { return 3; }
  void linearize(const Values& values, Eigen::Ref<Eigen::VectorXd> residual,
                 Eigen::Ref<Eigen::MatrixXd> jacobian) const override;
  void residual(const Values& values, Eigen::Ref<Eigen::VectorXd> residual) const override;

 private:
  std::array<Key, 1> keys_;
  Pose2 prior_T_map_base_;
  Eigen::Matrix3d sqrt_information_;
};

enum class RelativePoseError { kLogarithm, kComponents };

class RelativePose final : public Factor {
 public:
  // T_i_j measured; sqrt_information 3x3 in the frame of j (kLogarithm) or as g2o's Omega
  // (kComponents).
  RelativePose(Key pose_i, Key pose_j, const Pose2& T_i_j, const Eigen::Matrix3d& sqrt_information,
               RelativePoseError error = RelativePoseError::kLogarithm);

  [[nodiscard]] std::string_view type() const override { return "relative_pose"; }
  [[nodiscard]] std::span<const Key> keys() const override { return keys_; }
  [[nodiscard]] int dimension() const override { return 3; }
  void linearize(const Values& values, Eigen::Ref<Eigen::VectorXd> residual,
                 Eigen::Ref<Eigen::MatrixXd> jacobian) const override;
  void residual(const Values& values, Eigen::Ref<Eigen::VectorXd> residual) const override;

  [[nodiscard]] const Pose2& measured_T_i_j() const { return T_i_j_; }
  [[nodiscard]] Eigen::Matrix3d information() const {
    return sqrt_information_.transpose() * sqrt_information_;
  }

 private:
  [[nodiscard]] Eigen::Vector3d error(const Values& values) const;

  std::array<Key, 2> keys_;
  Pose2 T_i_j_;
  Eigen::Matrix3d sqrt_information_;
  RelativePoseError error_;
};

}  // namespace corridor::graph
