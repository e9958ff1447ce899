#include "slam/fusion/sensor_health.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/support/synthetic_scan.hpp"

namespace corridor::fusion {
namespace {

motion::ImuDelta imu_at_constant_velocity(double duration_s) {
  motion::ImuPreintegrator integrator(ImuModel{}, motion::ImuBias::Zero());
  for (double t = 0; t < duration_s - 1e-9; t += 0.005) integrator.integrate({}, 0.005);
  return integrator.delta();
}

SlipTest slip_for(const Pose2& wheels, const FusionParams& params) {
  return test_slip(wheels, nominal_wheel_noise(wheels, WheelModel{}, params),
                   imu_at_constant_velocity(0.4), {0.5, 0}, params.velocity_sigma_mps, 0.4,
                   ImuModel{}, params);
}

TEST(RangeDifference, OfTheSameViewIsItsNoiseFloor) {
  Rng rng(2);
  const auto walls = testing::corridor_walls();
  double sum = 0;
  for (int i = 0; i < 50; ++i) {
    const LaserScan a = testing::scan_of(walls, {}, 4.5, 0.015, rng);
    const LaserScan b = testing::scan_of(walls, {0.3, 0, 0}, 4.5, 0.015, rng);
    sum += *mean_range_difference_m(a, b, 0);
  }
  // 2 * 15 mm / sqrt(pi) = 16.9 mm; grazing beams that come and go move it by a few per cent.
  EXPECT_NEAR(sum / 50, range_difference_floor_m(0.015), 0.0015);
  EXPECT_NEAR(range_difference_floor_m(0.015), 0.01693, 1e-5);
}

TEST(RangeDifference, GrowsWhenTheViewChanges) {
  Rng rng(3);
  const auto walls = testing::room();
  const LaserScan a = testing::scan_of(walls, {}, 30, 0.015, rng);
  const LaserScan b = testing::scan_of(walls, {0.3, 0, 0}, 30, 0.015, rng);
  EXPECT_GT(*mean_range_difference_m(a, b, 0), 3 * range_difference_floor_m(0.015));
}

TEST(RangeDifference, TakesTheRobotsTurnOut) {
  Rng rng(4);
  const auto walls = testing::room();
  const double turn = 20 * 2 * std::numbers::pi / 360;
  for (const double sign : {-1.0, 1.0}) {
    const LaserScan a = testing::scan_of(walls, {0, 0, 0}, 30, 0.005, rng);
    const LaserScan b = testing::scan_of(walls, {0, 0, sign * turn}, 30, 0.005, rng);
    EXPECT_LT(*mean_range_difference_m(a, b, sign * turn), 0.02);
    EXPECT_GT(*mean_range_difference_m(a, b, 0), 0.2);
  }
}

TEST(RangeDifference, NeedsTenCommonBeams) {
  Rng rng(5);
  LaserScan blind = testing::scan_of(testing::room(), {}, 30, 0.01, rng);
  blind.is_valid.assign(blind.is_valid.size(), 0);
  EXPECT_FALSE(mean_range_difference_m(blind, blind, 0).has_value());
}

TEST(SlipTest, WheelsThatAgreeWithTheImuDoNotSlip) {
  FusionParams params;
  EXPECT_FALSE(slip_for({0.2, 0, 0}, params).is_slip);
  params.use_statistical_slip_test = false;
  EXPECT_FALSE(slip_for({0.2, 0, 0}, params).is_slip);
}

TEST(SlipTest, SpinningWheelsSlip) {
  FusionParams params;
  EXPECT_TRUE(slip_for({0.5, 0, 0}, params).is_slip);
  params.use_statistical_slip_test = false;
  EXPECT_TRUE(slip_for({0.5, 0, 0}, params).is_slip);
}

TEST(SlipTest, IsLessSureTheLongerNothingAnchoredTheVelocity) {
  const FusionParams params;
  const Pose2 wheels(0.24, 0, 0);
  const WheelNoise noise = nominal_wheel_noise(wheels, WheelModel{}, params);
  const motion::ImuDelta imu = imu_at_constant_velocity(0.4);
  const auto measure = [&](double age_s) {
    return test_slip(wheels, noise, imu, {0.5, 0}, params.velocity_sigma_mps, age_s, ImuModel{},
                     params)
        .measure_over_threshold;
  };
  EXPECT_GT(measure(0.4), measure(5));
  EXPECT_GT(measure(5), measure(50));
}

RC_GTEST_PROP(AdaptiveFactor, GrowsWithTheMeasureFromOne, (std::uint64_t seed)) {
  Rng rng(seed);
  const double low = rng.uniform(0, 2);
  const double high = low + rng.uniform(0.01, 2);
  RC_ASSERT(adaptive_factor(0) == 1);
  RC_ASSERT(adaptive_factor(low) < adaptive_factor(high));
}

TEST(WheelNoise, GrowsWithPathAndTurn) {
  const FusionParams params;
  const WheelModel model;
  const WheelNoise still = nominal_wheel_noise({}, model, params);
  const WheelNoise straight = nominal_wheel_noise({1, 0, 0}, model, params);
  const WheelNoise turning = nominal_wheel_noise({1, 0, 1}, model, params);
  EXPECT_EQ(still.translation_sigma_m, params.wheel_translation_floor_m);
  EXPECT_GT(straight.translation_sigma_m, still.translation_sigma_m);
  EXPECT_GT(turning.rotation_sigma_rad, straight.rotation_sigma_rad);
}

TEST(WheelNoiseAdapter, LearnsThatTheWheelsAreFourTimesWorse) {
  WheelNoiseAdapter adapter(50);
  Rng rng(6);
  for (int i = 0; i < 2000; ++i) {
    double square = 0;
    for (int k = 0; k < 3; ++k) square += std::pow(rng.normal(0, 4), 2);
    adapter.observe(square / 3 / (adapter.factor() * adapter.factor()));
  }
  EXPECT_NEAR(adapter.factor(), 4, 1);
}

TEST(WheelNoiseAdapter, OneGrossErrorDoesNotBlindTheWheels) {
  WheelNoiseAdapter adapter(50);
  adapter.observe(1e9);
  EXPECT_LT(adapter.factor(), 3);
}

TEST(WheelNoiseAdapter, NeverTrustsTheWheelsMoreThanTheirModel) {
  WheelNoiseAdapter adapter(50);
  for (int i = 0; i < 1000; ++i) adapter.observe(0);
  EXPECT_EQ(adapter.factor(), 1);
}

}  // namespace
}  // namespace corridor::fusion
