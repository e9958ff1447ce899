#include "slam/motion/imu_preintegration.hpp"

#include <cmath>

#include "slam/core/expect.hpp"

namespace corridor::motion {
namespace {

Eigen::Matrix2d rotation(double theta_rad) {
  const double c = std::cos(theta_rad);
  const double s = std::sin(theta_rad);
  return (Eigen::Matrix2d() << c, -s, s, c).finished();
}

// How a robot may have moved while nothing measured it, standard deviations.
constexpr double kUnmeasuredRate_radps = 1.0;
constexpr double kUnmeasuredAcceleration_mps2 = 1.0;

}  // namespace

ImuDelta ImuDelta::corrected(const ImuBias& other_bias) const {
  const ImuBias change = other_bias - bias;
  ImuDelta result = *this;
  result.bias = other_bias;
  result.theta_rad += theta_by_bias * change;
  result.velocity_mps += velocity_by_bias * change;
  result.position_m += position_by_bias * change;
  return result;
}

ImuPreintegrator::ImuPreintegrator(const ImuModel& model, const ImuBias& bias) : model_(model) {
  reset(bias);
}

void ImuPreintegrator::reset(const ImuBias& bias) {
  delta_ = ImuDelta{};
  delta_.bias = bias;
}

// What went unseen is one motion, however many pieces its time comes in: its standard deviations
// grow with the time as a whole.
void ImuPreintegrator::coast(double duration_s) {
  integrate({Timestamp{}, delta_.bias(0), delta_.bias(1), delta_.bias(2)}, duration_s);
  const auto variance_after = [](double time_s) {
    const double rotation = kUnmeasuredRate_radps * time_s;
    const double velocity = kUnmeasuredAcceleration_mps2 * time_s;
    const double position = 0.5 * velocity * time_s;
    return Eigen::Matrix<double, 5, 1>(
        Eigen::Matrix<double, 5, 1>{rotation, velocity, velocity, position, position}.cwiseAbs2());
  };
  const double before_s = delta_.unmeasured_s;
  delta_.unmeasured_s += duration_s;
  delta_.covariance.diagonal() += variance_after(delta_.unmeasured_s) - variance_after(before_s);
}

void ImuPreintegrator::integrate(const ImuSample& sample, double duration_s) {
  CORRIDOR_EXPECT(duration_s > 0);
  ImuDelta& d = delta_;
  const double dt = duration_s;
  const double stretch = 1 + d.bias(3);
  const double rate = stretch * (sample.gyro_z_radps - d.bias(0));
  const Eigen::Matrix2d R_base_imu = model_.T_base_imu.rotation();
  const Eigen::Vector2d force(sample.accel_x_mps2 - d.bias(1), sample.accel_y_mps2 - d.bias(2));
  const Eigen::Vector2d acceleration_base =
      R_base_imu * force + rate * rate * model_.T_base_imu.translation_m();

  // Midpoint rule: the rotation half way through the interval.
  const Eigen::Matrix2d R = rotation(d.theta_rad + 0.5 * rate * dt);
  const Eigen::Vector2d a = R * acceleration_base;
  const Eigen::Vector2d turned = perpendicular(a);

  Eigen::Matrix<double, 5, 5> F = Eigen::Matrix<double, 5, 5>::Identity();
  F.block<2, 1>(1, 0) = turned * dt;
  F.block<2, 1>(3, 0) = 0.5 * turned * dt * dt;
  F.block<2, 2>(3, 1) = Eigen::Matrix2d::Identity() * dt;
  Eigen::Matrix<double, 5, 3> G = Eigen::Matrix<double, 5, 3>::Zero();
  G(0, 0) = stretch * dt;
  // The lever arm's centripetal part depends on the rate.
  const Eigen::Vector2d a_by_rate = 2 * rate * (R * model_.T_base_imu.translation_m());
  G.block<2, 1>(1, 0) = stretch * a_by_rate * dt;
  G.block<2, 1>(3, 0) = 0.5 * stretch * a_by_rate * dt * dt;
  G.block<2, 2>(1, 1) = R * R_base_imu * dt;
  G.block<2, 2>(3, 1) = 0.5 * R * R_base_imu * dt * dt;
  const Eigen::Vector3d variance(model_.gyro_noise_radps * model_.gyro_noise_radps,
                                 model_.accel_noise_mps2 * model_.accel_noise_mps2,
                                 model_.accel_noise_mps2 * model_.accel_noise_mps2);
  d.covariance = F * d.covariance * F.transpose() + G * variance.asDiagonal() * G.transpose();

  const Eigen::RowVector4d rate_by_bias(-stretch, 0, 0, sample.gyro_z_radps - d.bias(0));
  const Eigen::RowVector4d theta_mid_by_bias = d.theta_by_bias + 0.5 * dt * rate_by_bias;
  Eigen::Matrix<double, 2, 4> a_by_bias = turned * theta_mid_by_bias + a_by_rate * rate_by_bias;
  a_by_bias.middleCols<2>(1) -= R * R_base_imu;
  d.position_by_bias += d.velocity_by_bias * dt + 0.5 * a_by_bias * dt * dt;
  d.velocity_by_bias += a_by_bias * dt;
  d.theta_by_bias += dt * rate_by_bias;

  d.position_m += d.velocity_mps * dt + 0.5 * a * dt * dt;
  d.velocity_mps += a * dt;
  d.theta_rad += rate * dt;
  d.duration_s += dt;
}

}  // namespace corridor::motion
