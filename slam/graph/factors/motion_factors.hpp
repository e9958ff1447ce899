// Factors of the moving robot: preintegrated IMU, preintegrated wheels with their calibration, and
// the walk of what changes slowly.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>

#include "slam/core/expect.hpp"
#include "slam/core/pose2.hpp"
#include "slam/graph/factor.hpp"
#include "slam/motion/imu_preintegration.hpp"
#include "slam/motion/wheel_preintegration.hpp"

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
  void linearize(const Values& values, FixedVector<5>& r, FixedMatrix<5, 14>& J) const;
  void residual(const Values& values, FixedVector<5>& r) const;

 private:
  std::array<Key, 5> keys_;
  motion::ImuDelta delta_;
  Eigen::Matrix<double, 5, 5> sqrt_information_;
};

// What the wheels say of the motion from i to j; keys (pose i, pose j, wheel calibration c).
// e = ( t(A^-1 T_i_j A) - d(c), wrap(theta_j - theta_i - dtheta(c)) ), 3 rows, in the axle's frame
// at i; A = T_base_axle of the calibration, d and dtheta those of the preintegrated delta at it. A
// row of zeros in sqrt_information leaves its component out: the heading where a gyro is better.
class WheelMotion {
 public:
  static constexpr std::string_view kName = "wheel_motion";
  static constexpr int kRows = 3;
  static constexpr std::array kKinds = {VariableKind::kPose, VariableKind::kPose,
                                        VariableKind::kWheelCalibration};

  WheelMotion(Key pose_i, Key pose_j, Key calibration, const motion::WheelDelta& delta,
              const Eigen::Matrix3d& sqrt_information);

  [[nodiscard]] const std::array<Key, 3>& keys() const { return keys_; }
  void linearize(const Values& values, FixedVector<3>& r, FixedMatrix<3, 13>& J) const;
  void residual(const Values& values, FixedVector<3>& r) const;

 private:
  std::array<Key, 3> keys_;
  motion::WheelDelta delta_;
  Eigen::Matrix3d sqrt_information_;
};

// A vector that changes slowly: e = (x_j - x_i) / sigma, component by component.
template <VariableKind kKind>
class VectorWalk {
 public:
  static constexpr std::string_view kName =
      kKind == VariableKind::kBias ? "bias_walk" : "calibration_walk";
  static constexpr int kRows = dimension_of(kKind);
  static constexpr bool kIsLinear = true;
  static constexpr std::array kKinds = {kKind, kKind};
  using Vector = FixedVector<kRows>;

  // sigma: standard deviation of the change, in the unit of the variable, each > 0.
  VectorWalk(std::uint32_t i, std::uint32_t j, const Vector& sigma)
      : keys_{Key{kKind, i}, Key{kKind, j}}, inverse_sigma_(sigma.cwiseInverse()) {
    CORRIDOR_EXPECT((sigma.array() > 0).all());
  }

  [[nodiscard]] const std::array<Key, 2>& keys() const { return keys_; }
  void linearize(const Values& values, Vector& r, FixedMatrix<kRows, 2 * kRows>& J) const {
    residual(values, r);
    J.setZero();
    J.template leftCols<kRows>().diagonal() = -inverse_sigma_;
    J.template rightCols<kRows>().diagonal() = inverse_sigma_;
  }
  void residual(const Values& values, Vector& r) const {
    r = inverse_sigma_.cwiseProduct(values.vector<kKind>(keys_[1].index) -
                                    values.vector<kKind>(keys_[0].index));
  }

 private:
  std::array<Key, 2> keys_;
  Vector inverse_sigma_;
};

using BiasWalk = VectorWalk<VariableKind::kBias>;
using WheelCalibrationWalk = VectorWalk<VariableKind::kWheelCalibration>;

}  // namespace corridor::graph
