// Rigid motions of the plane, SE(2), with exponential map, logarithm, adjoint and Jacobians.
// [Sola2018] sections IV-D and appendix B; equation numbers there. Nothing here allocates.
#pragma once

#include <Eigen/Core>

namespace corridor {

// Wraps to (-pi, pi]. `angle_rad` must be finite.
double wrap_angle(double angle_rad);

// v turned by +90 degrees: d R(theta) v / d theta = perpendicular(R(theta) v).
inline Eigen::Vector2d perpendicular(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

// T_a_b: p_a = T_a_b * p_b. Order of every vector and matrix: (x_m, y_m, theta_rad).
// Invariant: theta_rad lies in (-pi, pi] (the constructor wraps).
class Pose2 {
 public:
  // Element of the tangent space se(2): (rho_x_m, rho_y_m, theta_rad).
  using Tangent = Eigen::Vector3d;
  // 3x3, order (x_m, y_m, theta_rad).
  using Matrix = Eigen::Matrix3d;

  Pose2() = default;
  Pose2(double x_m, double y_m, double theta_rad);

  [[nodiscard]] double x_m() const { return x_m_; }
  [[nodiscard]] double y_m() const { return y_m_; }
  [[nodiscard]] double theta_rad() const { return theta_rad_; }
  [[nodiscard]] Eigen::Vector2d translation_m() const { return {x_m_, y_m_}; }
  [[nodiscard]] Eigen::Matrix2d rotation() const;
  [[nodiscard]] bool is_finite() const;

  [[nodiscard]] Pose2 inverse() const;
  // T_a_b * T_b_c = T_a_c.
  [[nodiscard]] Pose2 operator*(const Pose2& T_b_c) const;
  // p_a = T_a_b * p_b.
  [[nodiscard]] Eigen::Vector2d operator*(const Eigen::Vector2d& p_b) const;
  // (T_w_this)^-1 * T_w_other = T_this_other.
  [[nodiscard]] Pose2 between(const Pose2& T_w_other) const;

  // Exponential map, eq. 156-158; smooth through theta = 0.
  [[nodiscard]] static Pose2 exp(const Tangent& tau);
  // Inverse of exp for |theta| < pi, eq. 157.
  [[nodiscard]] Tangent log() const;
  // this * Exp(tau), eq. 25.
  [[nodiscard]] Pose2 plus(const Tangent& tau) const;
  // Log(other^-1 * this): the tau with other.plus(tau) == this, eq. 26.
  [[nodiscard]] Tangent minus(const Pose2& other) const;

  // X * Exp(tau) = Exp(Ad_X * tau) * X, eq. 159.
  [[nodiscard]] Matrix adjoint() const;
  // d Log(Exp(tau)^-1 Exp(tau + d)) / d d, eq. 163, and its inverse.
  [[nodiscard]] static Matrix right_jacobian(const Tangent& tau);
  [[nodiscard]] static Matrix right_jacobian_inverse(const Tangent& tau);
  // eq. 164: left_jacobian(tau) = right_jacobian(-tau).
  [[nodiscard]] static Matrix left_jacobian(const Tangent& tau);

  bool operator==(const Pose2&) const = default;

 private:
  double x_m_ = 0;
  double y_m_ = 0;
  double theta_rad_ = 0;
};

// Covariance of T_a_b with a right perturbation in b, seen as a left perturbation in a.
Pose2::Matrix transport_covariance(const Pose2& T_a_b, const Pose2::Matrix& covariance_b);

}  // namespace corridor
