#include "datasets/simulation/wheel_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

constexpr double kStep_s = 0.005;
constexpr double kExact = 1e-12;

TEST(WheelEncoders, WithoutErrorsCountThePathInWholeTicks) {
  const WheelParams params{.noise_ratio = 0};
  WheelEncoders encoders(params, {}, {}, Rng(1));
  // 0.5 m/s and 0.2 rad/s with a track of 0.35 m: wheels at 0.465 and 0.535 m/s.
  for (int k = 0; k < 400; ++k)
    encoders.advance(cruising(0.5, 0.2), cruising(0.5, 0.2), kStep_s, 0);
  const WheelSample sample = encoders.sample({});
  EXPECT_NEAR(static_cast<double>(sample.ticks->left), 9300, 1);
  EXPECT_NEAR(static_cast<double>(sample.ticks->right), 10700, 1);
  EXPECT_NEAR(sample.T_odom_base.theta_rad(), 0.4, 2e-4 / 0.35);  // one tick of each wheel
  // An arc of radius 2.5 m over 0.4 rad, integrated in one step.
  EXPECT_NEAR(sample.T_odom_base.x_m(), 2.5 * std::sin(0.4), 2e-4);
  EXPECT_NEAR(sample.T_odom_base.y_m(), 2.5 * (1 - std::cos(0.4)), 2e-4);
}

TEST(WheelEncoders, LoseNoPathToTicksWhenSampledOften) {
  const WheelParams params{.noise_ratio = 0};
  WheelEncoders often(params, {}, {}, Rng(1));
  for (int k = 0; k < 20000; ++k) {
    often.advance(cruising(0.013), cruising(0.013), kStep_s, 0);  // less than a tick per step
    often.sample({});
  }
  EXPECT_NEAR(often.sample({}).T_odom_base.x_m(), 1.3, 2e-4);
}

TEST(WheelEncoders, NoiseOfAMetreIsTheNominalSigmaPerRootMetre) {
  const Scenario scenario;
  const RobotModel robot = nominal_robot(scenario);
  std::vector<double> paths_m;
  for (std::uint64_t run = 0; run < 2000; ++run) {
    WheelEncoders encoders(scenario.wheels, robot.wheels, {}, Rng(run));
    for (int k = 0; k < 400; ++k) encoders.advance(cruising(0.5), cruising(0.5), kStep_s, 0);
    paths_m.push_back(static_cast<double>(encoders.sample({}).ticks->left) *
                      robot.wheels.left_m_per_tick);
  }
  // 2 % of 2.5 mm, 400 times: 1 mm. Counting whole ticks of 0.1 mm adds 0.03 mm in quadrature.
  EXPECT_NEAR(robot.wheels.sigma_m_per_sqrt_m, 0.001, kExact);
  EXPECT_NEAR(standard_deviation(paths_m), robot.wheels.sigma_m_per_sqrt_m,
              0.001 * five_sigma(paths_m.size()));
}

TEST(WheelEncoders, SpinByTheSlipRatioWhileTheRobotMovesOn) {
  const WheelParams params{.noise_ratio = 0};
  WheelEncoders encoders(params, {}, {}, Rng(1));
  for (int k = 0; k < 200; ++k) encoders.advance(cruising(0.5), cruising(0.5), kStep_s, 0.6);
  EXPECT_NEAR(encoders.sample({}).T_odom_base.x_m(), 0.5 * 1.6, 1e-4);
}

TEST(WheelEncoders, ScalesMultiplyTheRecordedPath) {
  const WheelParams params{.noise_ratio = 0};
  WheelEncoders encoders(params, {}, {.left_scale = 1.02, .right_scale = 0.99}, Rng(1));
  for (int k = 0; k < 2000; ++k) encoders.advance(cruising(0.5), cruising(0.5), kStep_s, 0);
  const WheelSample sample = encoders.sample({});
  EXPECT_NEAR(static_cast<double>(sample.ticks->left), 51000, 1);
  EXPECT_NEAR(static_cast<double>(sample.ticks->right), 49500, 1);
}

TEST(WheelErrors, HaveTheStatedSpreadInCommonAndInDifference) {
  std::vector<double> common, unbalance;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    const WheelErrors errors = draw_wheel_errors({}, Rng(seed));
    common.push_back((errors.left_scale + errors.right_scale) / 2);
    unbalance.push_back((errors.left_scale - errors.right_scale) / 2);
  }
  EXPECT_NEAR(standard_deviation(common), 0.01, 0.01 * five_sigma(common.size()));
  EXPECT_NEAR(standard_deviation(unbalance), 0.005, 0.005 * five_sigma(unbalance.size()));
  EXPECT_NEAR(mean(common), 1, 5 * 0.01 / std::sqrt(4000.0));
}

TEST(WheelErrors, TrackHasTheStatedSpread) {
  std::vector<double> ratios;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    ratios.push_back(draw_wheel_errors({.track_sigma = 0.02}, Rng(seed)).track_ratio);
  }
  EXPECT_NEAR(standard_deviation(ratios), 0.02, 0.02 * five_sigma(ratios.size()));
  EXPECT_NEAR(mean(ratios), 1, 5 * 0.02 / std::sqrt(4000.0));
}

TEST(WheelEncoders, WiderTrackThanStatedTurnsTheOdometryTooFar) {
  const WheelParams params{.noise_ratio = 0};
  WheelEncoders encoders(params, {}, {.track_ratio = 1.05}, Rng(1));
  for (int k = 0; k < 400; ++k)
    encoders.advance(cruising(0.5, 0.2), cruising(0.5, 0.2), kStep_s, 0);
  const WheelSample sample = encoders.sample({});
  EXPECT_NEAR(sample.T_odom_base.theta_rad(), 0.4 * 1.05, 2e-4 / 0.35);  // one tick of each wheel
  EXPECT_NEAR(static_cast<double>(sample.ticks->left + sample.ticks->right), 20000, 2);
}

// The floor lets the robot go at 0.3 m/s while the rims turn at 0.5 m/s.
TEST(WheelEncoders, CountTheRimsPathAndNotTheRobots) {
  const WheelParams params{.noise_ratio = 0};
  WheelEncoders encoders(params, {}, {}, Rng(1));
  DriveState slipping = cruising(0.3);
  slipping.wheel_speed_mps = 0.5;
  for (int k = 0; k < 200; ++k) encoders.advance(slipping, slipping, kStep_s, 0);
  EXPECT_NEAR(encoders.sample({}).T_odom_base.x_m(), 0.5, 2e-4);
}

TEST(WheelEncoders, CoarseTicksNeverMissMoreThanOneOfThem) {
  const WheelParams params{.m_per_tick = 0.01, .noise_ratio = 0};
  WheelModel nominal;
  nominal.left_m_per_tick = nominal.right_m_per_tick = 0.01;
  WheelEncoders encoders(params, nominal, {}, Rng(1));
  for (int k = 1; k <= 1000; ++k) {
    encoders.advance(cruising(0.47), cruising(0.47), kStep_s, 0);
    const double missed_m = 0.47 * kStep_s * k - encoders.sample({}).T_odom_base.x_m();
    EXPECT_GE(missed_m, -1e-9);
    EXPECT_LE(missed_m, 0.01 + 1e-9);
  }
}

}  // namespace
}  // namespace corridor::simulation::testing
