// Factors of the moving robot: preintegrated IMU, wheel displacement with a scale, bias walk, and
// priors on the plain vectors.
#pragma once

#include <Eigen/Core>
#include <array>

#include "slam/core/pose2.hpp"
#include "slam/graph/factor.hpp"
#include "slam/motion/imu_preintegration.hpp"

namespace corridor::graph {

// [Forster2017] eq. 45 in the plane; keys (pose i, velocity i, bias i, pose j, velocity j).
// e = ( wrap(theta_j - theta_i - dtheta(b)), R_i^T (v_j - v_i) - dv(b), R_i^T (p_j - p_i - v_i dt)
// - dp(b) ), 5 rows, whitened with the delta's covariance.
class ImuMotion final : public Factor {
 public:
  // Index i and j name pose, velocity and bias of one keyframe. The delta must last longer than 0
  // s.
  ImuMotion(std::uint32_t i, std::uint32_t j, const motion::ImuDelta& delta);

  [[nodiscard]] std::string_view type() const override { return "imu_motion"; }
  [[nodiscard]] std::span<const Key> keys() const override { return keys_; }
  [[nodiscard]] int dimension() const override { return 5; }
  void linearize(const Values& values, Eigen::Ref<Eigen::VectorXd> residual,
                 Eigen::Ref<Eigen::MatrixXd> jacobian) const override;
  void residual(const Values& values, Eigen::Ref<Eigen::VectorXd> residual) const override;

 private:
  std::array<Key, 5> keys_;
  motion::ImuDelta delta_;
  Eigen::Matrix<double, 5, 5> sqrt_information_;
};

// What the wheels say of the motion from i to j; keys (pose i, pose j, wheel scale).
// e = ( R_i^T (t_j - t_i) - (1 + scale) d, wrap(theta_j - theta_i - dtheta) ), 3 rows, in base i.
// A row of zeros in sqrt_information leaves its component out: the heading where a gyro is better.
class WheelMotion final : public Factor {
 public:
  WheelMotion(Key pose_i, Key pose_j, Key scale, const Pose2& wheel_T_i_j,
              const Eigen::Matrix3d& sqrt_information);

  [[nodiscard]] std::string_view type() const override { return "wheel_motion"; }
  [[nodiscard]] std::span<const Key> keys() const override { return keys_; }
  [[nodiscard]] int dimension() const override { return 3; }
  void linearize(const Values& values, Eigen::Ref<Eigen::VectorXd> residual,
                 Eigen::Ref<Eigen::MatrixXd> jacobian) const override;
  void residual(const Values& values, Eigen::Ref<Eigen::VectorXd> residual) const override;

 private:
  std::array<Key, 3> keys_;
  Pose2 wheel_T_i_j_;
  Eigen::Matrix3d sqrt_information_;
};

// e = (b_j - b_i) / sigma, component by component; keys (bias i, bias j).
class BiasWalk final : public Factor {
 public:
  // sigma: standard deviation of the change, (rad/s, m/s^2, m/s^2), each > 0.
  BiasWalk(std::uint32_t i, std::uint32_t j, const Eigen::Vector3d& sigma);

  [[nodiscard]] std::string_view type() const override { return "bias_walk"; }
  [[nodiscard]] std::span<const Key> keys() const override { return keys_; }
  [[nodiscard]] int dimension() const override { return 3; }
  void linearize(const Values& values, Eigen::Ref<Eigen::VectorXd> residual,
                 Eigen::Ref<Eigen::MatrixXd> jacobian) const override;
  void residual(const Values& values, Eigen::Ref<Eigen::VectorXd> residual) const override;

 private:
  std::array<Key, 2> keys_;
  Eigen::Vector3d inverse_sigma_;
};

// e = (x - prior) / sigma for a velocity, bias or wheel scale.
class VectorPrior final : public Factor {
 public:
  // prior and sigma have key.dimension() rows; sigma > 0.
  VectorPrior(Key key, const Eigen::VectorXd& prior, const Eigen::VectorXd& sigma);

  [[nodiscard]] std::string_view type() const override { return "vector_prior"; }
  [[nodiscard]] std::span<const Key> keys() const override { return keys_; }
  [[nodiscard]] int dimension() const override { return keys_[0].dimension(); }
  void linearize(const Values& values, Eigen::Ref<Eigen::VectorXd> residual,
                 Eigen::Ref<Eigen::MatrixXd> jacobian) const override;
  void residual(const Values& values, Eigen::Ref<Eigen::VectorXd> residual) const override;

 private:
  std::array<Key, 1> keys_;
  Eigen::VectorXd prior_;
  Eigen::VectorXd inverse_sigma_;
};

}  // namespace corridor::graph
