#include "slam/core/pose2.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace corridor {
namespace {

// Below this angle the series is exact to double precision (next term ~ theta^4 / 120).
constexpr double kSmallAngle_rad = 1e-4;

// 1 - cos(t) by the half angle: the difference itself loses half of its digits near 1e-4.
double one_minus_cos(double theta_rad) {
  const double half_sine = std::sin(theta_rad / 2);
  return 2 * half_sine * half_sine;
}

// sin(t)/t and (1 - cos(t))/t, the two entries of V(theta), eq. 158.
struct Sincs {
  double sinc;
  double cosc;
};

Sincs sincs(double theta_rad) {
  if (std::abs(theta_rad) < kSmallAngle_rad) {
    const double t2 = theta_rad * theta_rad;
    return {1 - t2 / 6, theta_rad * (0.5 - t2 / 24)};
  }
  return {std::sin(theta_rad) / theta_rad, one_minus_cos(theta_rad) / theta_rad};
}

// (t - sin t)/t^2 and (1 - cos t)/t^2, used by the Jacobian's last column, eq. 163.
Sincs second_order_sincs(double theta_rad) {
  if (std::abs(theta_rad) < kSmallAngle_rad) {
    return {theta_rad / 6, 0.5 - theta_rad * theta_rad / 24};
  }
  const double t2 = theta_rad * theta_rad;
  return {(theta_rad - std::sin(theta_rad)) / t2, one_minus_cos(theta_rad) / t2};
}

}  // namespace

double wrap_angle(double angle_rad) {
  constexpr double kTurn_rad = 2 * std::numbers::pi;
  if (std::abs(angle_rad) < std::numbers::pi) return angle_rad;  // as it is nearly always
  double wrapped = std::remainder(angle_rad, kTurn_rad);
  if (wrapped <= -std::numbers::pi) wrapped += kTurn_rad;
  return wrapped;
}

Pose2::Pose2(double x_m, double y_m, double theta_rad)
    : x_m_(x_m), y_m_(y_m), theta_rad_(wrap_angle(theta_rad)) {}

Eigen::Matrix2d Pose2::rotation() const {
  const double c = std::cos(theta_rad_);
  const double s = std::sin(theta_rad_);
  return (Eigen::Matrix2d() << c, -s, s, c).finished();
}

bool Pose2::is_finite() const {
  return std::isfinite(x_m_) && std::isfinite(y_m_) && std::isfinite(theta_rad_);
}

Pose2 Pose2::inverse() const {
  const double c = std::cos(theta_rad_);
  const double s = std::sin(theta_rad_);
  return {-c * x_m_ - s * y_m_, s * x_m_ - c * y_m_, -theta_rad_};
}

Pose2 Pose2::operator*(const Pose2& T_b_c) const {
  const double c = std::cos(theta_rad_);
  const double s = std::sin(theta_rad_);
  return {x_m_ + c * T_b_c.x_m_ - s * T_b_c.y_m_, y_m_ + s * T_b_c.x_m_ + c * T_b_c.y_m_,
          theta_rad_ + T_b_c.theta_rad_};
}

Eigen::Vector2d Pose2::operator*(const Eigen::Vector2d& p_b) const {
  const double c = std::cos(theta_rad_);
  const double s = std::sin(theta_rad_);
  return {x_m_ + c * p_b.x() - s * p_b.y(), y_m_ + s * p_b.x() + c * p_b.y()};
}

Pose2 Pose2::between(const Pose2& T_w_other) const { return inverse() * T_w_other; }

Pose2 Pose2::exp(const Tangent& tau) {
  const auto [a, b] = sincs(tau.z());
  return {a * tau.x() - b * tau.y(), b * tau.x() + a * tau.y(), tau.z()};
}

Pose2::Tangent Pose2::log() const {
  const auto [a, b] = sincs(theta_rad_);
  const double norm2 = a * a + b * b;
  return {(a * x_m_ + b * y_m_) / norm2, (-b * x_m_ + a * y_m_) / norm2, theta_rad_};
}

Pose2 Pose2::plus(const Tangent& tau) const { return *this * exp(tau); }

Pose2::Tangent Pose2::minus(const Pose2& other) const { return other.between(*this).log(); }

Pose2::Matrix Pose2::adjoint() const {
  Matrix adjoint = Matrix::Identity();
  adjoint.topLeftCorner<2, 2>() = rotation();
  adjoint(0, 2) = y_m_;
  adjoint(1, 2) = -x_m_;
  return adjoint;
}

Pose2::Matrix Pose2::right_jacobian(const Tangent& tau) {
  const auto [a, b] = sincs(tau.z());
  const auto [p, q] = second_order_sincs(tau.z());
  Matrix jacobian = Matrix::Identity();
  jacobian(0, 0) = a;
  jacobian(0, 1) = b;
  jacobian(1, 0) = -b;
  jacobian(1, 1) = a;
  jacobian(0, 2) = p * tau.x() - q * tau.y();
  jacobian(1, 2) = q * tau.x() + p * tau.y();
  return jacobian;
}

Pose2::Matrix Pose2::right_jacobian_inverse(const Tangent& tau) {
  return right_jacobian(tau).inverse();
}

Pose2::Matrix Pose2::left_jacobian(const Tangent& tau) { return right_jacobian(-tau); }

Pose2::Matrix transport_covariance(const Pose2& T_a_b, const Pose2::Matrix& covariance_b) {
  const Pose2::Matrix adjoint = T_a_b.adjoint();
  return adjoint * covariance_b * adjoint.transpose();
}

}  // namespace corridor
