#include "datasets/simulation/simulated_sensors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

constexpr double kStep_s = 0.005;
constexpr double kExact = 1e-12;

// Five standard errors of a standard deviation estimated from n normal samples, as a part of it.
double five_sigma(std::size_t num_samples) {
  return 5 / std::sqrt(2.0 * static_cast<double>(num_samples));
}

DriveState cruising(double speed_mps, double yaw_rate_radps = 0) {
  return {.T_world_base = {}, .speed_mps = speed_mps, .yaw_rate_radps = yaw_rate_radps};
}

class LidarInAWideCorridor : public ::testing::Test {
 protected:
  const World world_ = make_corridor({});
  const RayCaster caster_{world_};
  const Pose2 T_world_base_{10, 2.3, 0.4};
};

TEST_F(LidarInAWideCorridor, BeamsPointHalfAnIncrementPastMinusPi) {
  const LaserScan scan = measure_scan(cast_beams(caster_, T_world_base_, {}), {}, {}, Rng(1));
  ASSERT_EQ(scan.num_beams(), 360u);
  const double degree_rad = std::numbers::pi / 180;
  EXPECT_NEAR(scan.angle_rad(0), -179.5 * degree_rad, kExact);
  EXPECT_NEAR(scan.angle_rad(359), 179.5 * degree_rad, kExact);
}

TEST_F(LidarInAWideCorridor, NoiselessEndPointsLieOnTheWalls) {
  LidarParams params;
  params.range_sigma_m = 0;
  const LaserScan scan =
      measure_scan(cast_beams(caster_, T_world_base_, params), {}, params, Rng(1));
  for (std::size_t i = 0; i < scan.num_beams(); ++i) {
    if (!scan.is_valid[i]) continue;
    // Ranges are stored as float.
    EXPECT_LT(clearance_m(world_, T_world_base_ * scan.point_base_m(i)), 1e-6) << "beam " << i;
  }
}

TEST_F(LidarInAWideCorridor, RangeNoiseIsWhiteWithTheStatedSigma) {
  const LidarParams params{.range_max_m = 100};
  const auto hits = cast_beams(caster_, T_world_base_, params);
  std::vector<double> errors_m;
  for (std::uint64_t scan_index = 0; scan_index < 100; ++scan_index) {
    const LaserScan scan = measure_scan(hits, {}, params, Rng(7).stream(scan_index));
    for (std::size_t i = 0; i < hits.size(); ++i) {
      errors_m.push_back(scan.ranges_m[i] - hits[i]->range_m);
    }
  }
  EXPECT_NEAR(standard_deviation(errors_m), 0.015, 0.015 * five_sigma(errors_m.size()));
  EXPECT_NEAR(mean(errors_m), 0, 5 * 0.015 / std::sqrt(static_cast<double>(errors_m.size())));
}

TEST_F(LidarInAWideCorridor, BeamWithoutReturnIsOneMetreBeyondTheRangeAndInvalid) {
  const LidarParams params;
  const auto hits = cast_beams(caster_, T_world_base_, params);
  const LaserScan scan = measure_scan(hits, {}, params, Rng(1));
  std::size_t num_without = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i]) continue;
    ++num_without;
    EXPECT_EQ(scan.is_valid[i], 0);
    EXPECT_EQ(scan.ranges_m[i], 5.5f);
  }
  EXPECT_GT(num_without, 100u);
}

TEST_F(LidarInAWideCorridor, NoiseOfABeamDoesNotDependOnTheRange) {
  const LidarParams near{.range_max_m = 4.5};
  const LidarParams far{.range_max_m = 12};
  const LaserScan near_scan =
      measure_scan(cast_beams(caster_, T_world_base_, near), {}, near, Rng(3));
  const LaserScan far_scan = measure_scan(cast_beams(caster_, T_world_base_, far), {}, far, Rng(3));
  for (std::size_t i = 0; i < near_scan.num_beams(); ++i) {
    if (near_scan.is_valid[i]) {
      EXPECT_EQ(near_scan.ranges_m[i], far_scan.ranges_m[i]);
    }
  }
}

TEST(MeasureScan, NoisyRangePastTheLimitIsNoReturn) {
  const LidarParams params{.num_beams = 4, .range_max_m = 4.5, .range_sigma_m = 0.015};
  const std::vector<std::optional<RayCaster::Hit>> hits(4, RayCaster::Hit{4.4999, 0});
  int num_valid = 0;
  for (std::uint64_t k = 0; k < 500; ++k) {
    const LaserScan scan = measure_scan(hits, {}, params, Rng(1).stream(k));
    for (std::size_t i = 0; i < 4; ++i) {
      num_valid += scan.is_valid[i];
      if (scan.is_valid[i]) {
        EXPECT_LE(scan.ranges_m[i], 4.5f);
      }
    }
  }
  EXPECT_NEAR(num_valid / 2000.0, 0.5, 5 * 0.5 / std::sqrt(2000.0));
}

TEST(WheelEncoders, WithoutErrorsCountThePathInWholeTicks) {
  const WheelParams params{.noise_ratio = 0};
  WheelEncoders encoders(params, {}, {1, 1}, Rng(1));
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
  WheelEncoders often(params, {}, {1, 1}, Rng(1));
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
    WheelEncoders encoders(scenario.wheels, robot.wheels, {1, 1}, Rng(run));
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
  WheelEncoders encoders(params, {}, {1, 1}, Rng(1));
  for (int k = 0; k < 200; ++k) encoders.advance(cruising(0.5), cruising(0.5), kStep_s, 0.6);
  EXPECT_NEAR(encoders.sample({}).T_odom_base.x_m(), 0.5 * 1.6, 1e-4);
}

TEST(WheelEncoders, ScalesMultiplyTheRecordedPath) {
  const WheelParams params{.noise_ratio = 0};
  WheelEncoders encoders(params, {}, {1.02, 0.99}, Rng(1));
  for (int k = 0; k < 2000; ++k) encoders.advance(cruising(0.5), cruising(0.5), kStep_s, 0);
  const WheelSample sample = encoders.sample({});
  EXPECT_NEAR(static_cast<double>(sample.ticks->left), 51000, 1);
  EXPECT_NEAR(static_cast<double>(sample.ticks->right), 49500, 1);
}

TEST(WheelScales, HaveTheStatedSpreadInCommonAndInDifference) {
  std::vector<double> common, unbalance;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    const WheelScales scales = draw_wheel_scales({}, Rng(seed));
    common.push_back((scales.left + scales.right) / 2);
    unbalance.push_back((scales.left - scales.right) / 2);
  }
  EXPECT_NEAR(standard_deviation(common), 0.01, 0.01 * five_sigma(common.size()));
  EXPECT_NEAR(standard_deviation(unbalance), 0.005, 0.005 * five_sigma(unbalance.size()));
  EXPECT_NEAR(mean(common), 1, 5 * 0.01 / std::sqrt(4000.0));
}

TEST(Imu, WithoutErrorsReadsSpeedChangeAndCentripetalAcceleration) {
  const ImuParams params{.gyro_noise_radps = 0, .accel_noise_mps2 = 0};
  Rng rng(1);
  const ImuSample sample =
      measure_imu(cruising(0.40, 0.3), cruising(0.41, 0.5), 0.02, {}, {}, params, rng);
  EXPECT_NEAR(sample.gyro_z_radps, 0.5, kExact);
  EXPECT_NEAR(sample.accel_x_mps2, 0.5, kExact);
  EXPECT_NEAR(sample.accel_y_mps2, 0.41 * 0.5, kExact);
}

TEST(Imu, NoiseAndBiasAreTheStatedOnes) {
  const ImuBias bias{0.004, -0.02, 0.05};
  Rng rng(5);
  std::vector<double> gyro, accel_x, accel_y;
  for (int k = 0; k < 20000; ++k) {
    const ImuSample sample = measure_imu(cruising(0.5), cruising(0.5), kStep_s, {}, bias, {}, rng);
    gyro.push_back(sample.gyro_z_radps);
    accel_x.push_back(sample.accel_x_mps2);
    accel_y.push_back(sample.accel_y_mps2);
  }
  const double share = five_sigma(gyro.size());
  const double mean_share = 5 / std::sqrt(static_cast<double>(gyro.size()));
  EXPECT_NEAR(standard_deviation(gyro), 0.01, 0.01 * share);
  EXPECT_NEAR(standard_deviation(accel_x), 0.05, 0.05 * share);
  EXPECT_NEAR(standard_deviation(accel_y), 0.05, 0.05 * share);
  EXPECT_NEAR(mean(gyro), 0.004, 0.01 * mean_share);
  EXPECT_NEAR(mean(accel_x), -0.02, 0.05 * mean_share);
  EXPECT_NEAR(mean(accel_y), 0.05, 0.05 * mean_share);
}

TEST(Imu, BiasesHaveTheStatedSpread) {
  std::vector<double> gyro, accel;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    const ImuBias bias = draw_imu_bias({}, Rng(seed));
    gyro.push_back(bias.gyro_radps);
    accel.push_back(bias.accel_y_mps2);
  }
  EXPECT_NEAR(standard_deviation(gyro), 0.003, 0.003 * five_sigma(gyro.size()));
  EXPECT_NEAR(standard_deviation(accel), 0.03, 0.03 * five_sigma(accel.size()));
}

}  // namespace
}  // namespace corridor::simulation::testing
