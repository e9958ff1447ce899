// Factors of the moving robot: preintegrated IMU, wheel displacement with a scale, bias walk.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>

#include "slam/core/pose2.hpp"
#include "slam/graph/factor.hpp"
#include "slam/motion/imu_preintegration.hpp"

namespace corridor::graph {

// [Forster2017] eq. 45 in the plane; keys (pose i, velocity i, bias i, pose j, velocity j).
// e = ( wrap(theta_j - theta_i - dtheta(b)), R_i^T (v_j - v_i) - dv(b), R_i^T (p_j - p_i - v_i dt)
// - dp(b) ), 5 rows, whitened with the delta's covariance.
class ImuMotion {
 public:
  static constexpr std::string_view kName = "imu_motion";
  static constexpr int kRows = 5;
  static constexpr std::array kKinds = {VariableKind::kPose, VariableKind::kVelocity,
                                        VariableKind::kBias, VariableKind::kPose,
                                        VariableKind::kVelocity};

  // Index i and j name pose, velocity and bias of one keyframe. The delta must last longer than 0
  // s.
  ImuMotion(std::uint32_t i, std::uint32_t j, const motion::ImuDelta& delta);

  [[nodiscard]] const std::array<Key, 5>& keys() const { return keys_; }
  void linearize(const Values& values, FixedVector<5>& r, FixedMatrix<5, 13>& J) const;
  void residual(const Values& values, FixedVector<5>& r) const;

 private:
  std::array<Key, 5> keys_;
  motion::ImuDelta delta_;
  Eigen::Matrix<double, 5, 5> sqrt_information_;
};

// What the wheels say of the motion from i to j; keys (pose i, pose j, wheel scale).
// e = ( R_i^T (t_j - t_i) - (1 + scale) d, wrap(theta_j - theta_i - dtheta) ), 3 rows, in base i.
// A row of zeros in sqrt_information leaves its component out: the heading where a gyro is better.
class WheelMotion {
 public:
  static constexpr std::string_view kName = "wheel_motion";
  static constexpr int kRows = 3;
  static constexpr std::array kKinds = {VariableKind::kPose, VariableKind::kPose,
                                        VariableKind::kWheelScale};

  WheelMotion(Key pose_i, Key pose_j, Key scale, const Pose2& wheel_T_i_j,
              const Eigen::Matrix3d& sqrt_information);

  [[nodiscard]] const std::array<Key, 3>& keys() const { return keys_; }
  void linearize(const Values& values, FixedVector<3>& r, FixedMatrix<3, 7>& J) const;
  void residual(const Values& values, FixedVector<3>& r) const;

 private:
  std::array<Key, 3> keys_;
  Pose2 wheel_T_i_j_;
  Eigen::Matrix3d sqrt_information_;
};

// e = (b_j - b_i) / sigma, component by component; keys (bias i, bias j).
class BiasWalk {
 public:
  static constexpr std::string_view kName = "bias_walk";
  static constexpr int kRows = 3;
  static constexpr std::array kKinds = {VariableKind::kBias, VariableKind::kBias};

  // sigma: standard deviation of the change, (rad/s, m/s^2, m/s^2), each > 0.
  BiasWalk(std::uint32_t i, std::uint32_t j, const Eigen::Vector3d& sigma);

  [[nodiscard]] const std::array<Key, 2>& keys() const { return keys_; }
  void linearize(const Values& values, FixedVector<3>& r, FixedMatrix<3, 6>& J) const;
  void residual(const Values& values, FixedVector<3>& r) const;

 private:
  std::array<Key, 2> keys_;
  Eigen::Vector3d inverse_sigma_;
};

}  // namespace corridor::graph
