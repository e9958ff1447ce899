// Factors on planar poses: prior, relative pose, and relative pose in some directions only.
// Error of a relative pose [Konolige2010] eq. 2, with the group's logarithm instead of the
// component difference: e = Log(z^-1 * (T_map_i^-1 * T_map_j)) = Log(Z_j_j'), in the frame of the
// measured j. RelativePoseError::kComponents gives the form of g2o instead: e = (R_z^T (R_i^T (t_j
// - t_i) - t_z), wrap(theta_j - theta_i - theta_z)); both agree to first order and are zero at the
// same poses.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>

#include "slam/graph/factor.hpp"

namespace corridor::graph {

// U with U^T U = information for a positive semi-definite 3x3 matrix: row i = sqrt(lambda_i) v_i^T
// of its eigen-decomposition. Rows of zeros (lambda_i <= 1e-15 of the largest) stand for
// unconstrained directions.
Eigen::Matrix3d square_root_information(const Eigen::Matrix3d& information);

// e = Log(prior^-1 * T_map_base), tangent order (x_m, y_m, theta_rad).
class PosePrior {
 public:
  static constexpr std::string_view kName = "pose_prior";
  static constexpr int kRows = 3;
  static constexpr std::array kKinds = {VariableKind::kPose};

  // sqrt_information: 3x3 U with U^T U = information in base.
  PosePrior(Key pose, const Pose2& prior_T_map_base, const Eigen::Matrix3d& sqrt_information);

  [[nodiscard]] const std::array<Key, 1>& keys() const { return keys_; }
  void linearize(const Values& values, FixedVector<3>& r, FixedMatrix<3, 3>& J) const;
  void residual(const Values& values, FixedVector<3>& r) const;

 private:
  std::array<Key, 1> keys_;
  Pose2 prior_T_map_base_;
  Eigen::Matrix3d sqrt_information_;
};

enum class RelativePoseError { kLogarithm, kComponents };

class RelativePose {
 public:
  static constexpr std::string_view kName = "relative_pose";
  static constexpr int kRows = 3;
  static constexpr std::array kKinds = {VariableKind::kPose, VariableKind::kPose};

  // T_i_j measured; sqrt_information 3x3 in the frame of j (kLogarithm) or as g2o's Omega
  // (kComponents).
  RelativePose(Key pose_i, Key pose_j, const Pose2& T_i_j, const Eigen::Matrix3d& sqrt_information,
               RelativePoseError error = RelativePoseError::kLogarithm);

  [[nodiscard]] const std::array<Key, 2>& keys() const { return keys_; }
  void linearize(const Values& values, FixedVector<3>& r, FixedMatrix<3, 6>& J) const;
  void residual(const Values& values, FixedVector<3>& r) const;

  [[nodiscard]] const Pose2& measured_T_i_j() const { return measured_.pose; }
  [[nodiscard]] Eigen::Matrix3d information() const {
    return sqrt_information_.transpose() * sqrt_information_;
  }

 private:
  std::array<Key, 2> keys_;
  OrientedPose measured_;
  Eigen::Matrix3d sqrt_information_;
  RelativePoseError error_;
};

}  // namespace corridor::graph
