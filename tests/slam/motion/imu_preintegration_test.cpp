#include "slam/motion/imu_preintegration.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

#include "slam/core/rng.hpp"

namespace corridor::motion {
namespace {

constexpr double kDt_s = 0.005;

ImuDelta integrate(const std::vector<ImuSample>& samples, const ImuBias& bias,
                   const ImuModel& model = {}) {
  ImuPreintegrator integrator(model, bias);
  for (const ImuSample& sample : samples) integrator.integrate(sample, kDt_s);
  return integrator.delta();
}

std::vector<ImuSample> random_samples(Rng& rng, int count) {
  std::vector<ImuSample> samples;
  const double rate = rng.normal(0, 0.5);
  for (int i = 0; i < count; ++i) {
    samples.push_back({{}, rate + rng.normal(0, 0.1), rng.normal(0.3, 0.5), rng.normal(0, 0.5)});
  }
  return samples;
}

TEST(ImuPreintegrator, UniformAccelerationGivesTheSchoolFormula) {
  const ImuDelta delta = integrate(std::vector<ImuSample>(200, {{}, 0, 2, 0}), ImuBias::Zero());
  EXPECT_NEAR(delta.duration_s, 1, 1e-12);
  EXPECT_NEAR(delta.velocity_mps.x(), 2, 1e-12);
  EXPECT_NEAR(delta.position_m.x(), 1, 1e-12);
  EXPECT_NEAR(delta.position_m.y(), 0, 1e-12);
}

TEST(ImuPreintegrator, CircularMotionComesBackToItsStart) {
  // Speed 1 m/s on a circle of radius 1 m: centripetal 1 m/s^2 to the left, one turn in 2 pi s.
  constexpr int kSteps = 1257;
  ImuPreintegrator integrator(ImuModel{}, ImuBias::Zero());
  const double dt = 2 * M_PI / kSteps;
  for (int i = 0; i < kSteps; ++i) integrator.integrate({{}, 1, 0, 1}, dt);
  const ImuDelta& delta = integrator.delta();
  const Eigen::Vector2d displacement =
      Eigen::Vector2d(1, 0) * delta.duration_s + delta.position_m;  // initial velocity 1 m/s
  EXPECT_NEAR(displacement.norm(), 0, 1e-4);
  EXPECT_NEAR(delta.velocity_mps.norm(), 0, 1e-4);
  EXPECT_NEAR(delta.theta_rad, 2 * M_PI, 1e-9);
}

TEST(ImuPreintegrator, TakesTheCentripetalPartOfTheLeverArmOut) {
  // Turning on the spot at 2 rad/s with the IMU 0.5 m ahead: it feels -2 m/s^2 along x, the base
  // nothing.
  ImuModel model;
  model.T_base_imu = Pose2(0.5, 0, 0);
  const ImuDelta delta =
      integrate(std::vector<ImuSample>(100, {{}, 2, -2, 0}), ImuBias::Zero(), model);
  EXPECT_NEAR(delta.position_m.norm(), 0, 1e-12);
}

TEST(ImuPreintegrator, TurnsTheForceFromTheImusIntoTheBaseFrame) {
  ImuModel model;
  model.T_base_imu = Pose2(0, 0, M_PI / 2);
  const ImuDelta delta =
      integrate(std::vector<ImuSample>(200, {{}, 0, 0, -1}), ImuBias::Zero(), model);
  EXPECT_NEAR(delta.velocity_mps.x(), 1, 1e-12);
  EXPECT_NEAR(delta.velocity_mps.y(), 0, 1e-12);
}

RC_GTEST_PROP(ImuPreintegrator, BiasCorrectionIsRightToFirstOrder, (std::uint64_t seed)) {
  Rng rng(seed);
  const std::vector<ImuSample> samples = random_samples(rng, 100);
  const ImuBias bias(0.01, -0.02, 0.03, 0.05);
  ImuModel model;
  model.T_base_imu = Pose2(0.3, -0.1, 0.4);  // a lever arm makes the force depend on the rate
  const ImuDelta delta = integrate(samples, bias, model);
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 4; ++i) {
    const ImuBias moved = bias + kStep * ImuBias::Unit(i);
    const ImuDelta exact = integrate(samples, moved, model);
    const ImuDelta corrected = delta.corrected(moved);
    // What is left is of second order: (1e-5)^2 times a factor near 1, against a change near 1e-5.
    RC_ASSERT(std::abs(corrected.theta_rad - exact.theta_rad) < 1e-9);
    RC_ASSERT((corrected.velocity_mps - exact.velocity_mps).norm() < 1e-9);
    RC_ASSERT((corrected.position_m - exact.position_m).norm() < 1e-9);
  }
}

TEST(ImuPreintegrator, CovarianceIsThatOfRepeatedNoisyRuns) {
  const ImuModel model;
  std::vector<ImuSample> clean;
  for (int i = 0; i < 80; ++i) clean.push_back({{}, 0.5, 0.3 * std::sin(0.1 * i), 0.2});
  const ImuDelta reference = integrate(clean, ImuBias::Zero(), model);
  constexpr int kRuns = 4000;
  Eigen::Matrix<double, 5, 5> sum = Eigen::Matrix<double, 5, 5>::Zero();
  Rng rng(11);
  for (int run = 0; run < kRuns; ++run) {
    std::vector<ImuSample> noisy = clean;
    for (ImuSample& s : noisy) {
      s.gyro_z_radps += rng.normal(0, model.gyro_noise_radps);
      s.accel_x_mps2 += rng.normal(0, model.accel_noise_mps2);
      s.accel_y_mps2 += rng.normal(0, model.accel_noise_mps2);
    }
    const ImuDelta delta = integrate(noisy, ImuBias::Zero(), model);
    Eigen::Matrix<double, 5, 1> e;
    e << delta.theta_rad - reference.theta_rad, delta.velocity_mps - reference.velocity_mps,
        delta.position_m - reference.position_m;
    sum += e * e.transpose();
  }
  const Eigen::Matrix<double, 5, 5> sampled = sum / kRuns;
  // A variance from 4000 runs is good to sqrt(2 / 4000) = 2.2 %; five of those.
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(sampled(i, i) / reference.covariance(i, i), 1, 0.11) << i;
  }
}

TEST(ImuPreintegrator, ResetStartsAnewWithTheBias) {
  ImuPreintegrator integrator(ImuModel{}, ImuBias::Zero());
  integrator.integrate({{}, 1, 1, 1}, 0.1);
  integrator.reset({0.1, 0.2, 0.3, 0});
  EXPECT_EQ(integrator.delta().duration_s, 0);
  integrator.integrate({{}, 0.1, 0.2, 0.3}, 0.1);
  EXPECT_NEAR(integrator.delta().theta_rad, 0, 1e-15);
  EXPECT_NEAR(integrator.delta().velocity_mps.norm(), 0, 1e-15);
}

}  // namespace
}  // namespace corridor::motion
