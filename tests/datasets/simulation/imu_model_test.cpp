#include "datasets/simulation/imu_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

constexpr double kStep_s = 0.005;
constexpr double kExact = 1e-12;

TEST(Imu, WithoutErrorsReadsSpeedChangeAndCentripetalAcceleration) {
  const ImuParams params{.gyro_noise_radps_rthz = 0, .accel_noise_mps2_rthz = 0};
  ImuModel2d imu(params, {}, 0.02, Rng(1));
  const ImuSample sample = imu.measure(cruising(0.40, 0.3), cruising(0.41, 0.5), {});
  EXPECT_NEAR(sample.gyro_z_radps, 0.5, kExact);
  EXPECT_NEAR(sample.accel_x_mps2, 0.5, kExact);
  EXPECT_NEAR(sample.accel_y_mps2, 0.41 * 0.5, kExact);
}

TEST(Imu, NoiseAndBiasAreTheStatedOnes) {
  const ImuErrors errors{
      .gyro_bias_radps = 0.004, .accel_bias_x_mps2 = -0.02, .accel_bias_y_mps2 = 0.05};
  ImuModel2d imu({}, errors, kStep_s, Rng(5));
  std::vector<double> gyro, accel_x, accel_y;
  for (int k = 0; k < 20000; ++k) {
    const ImuSample sample = imu.measure(cruising(0.5), cruising(0.5), {});
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

// Everything that is random turned off.
constexpr ImuParams kHonest{.gyro_noise_radps_rthz = 0, .accel_noise_mps2_rthz = 0};

std::vector<double> gyro_at_rest(const ImuParams& params, std::size_t num_samples,
                                 std::uint64_t seed) {
  ImuModel2d imu(params, {}, 1 / params.rate_hz, Rng(seed));
  std::vector<double> readings;
  for (std::size_t k = 0; k < num_samples; ++k) {
    readings.push_back(imu.measure(cruising(0), cruising(0), {}).gyro_z_radps);
  }
  return readings;
}

TEST(ImuAllanDeviation, OfWhiteNoiseIsItsDensityAtOneSecondWhateverTheRate) {
  for (const double rate_hz : {50.0, 200.0}) {
    const ImuParams params{.rate_hz = rate_hz, .gyro_noise_radps_rthz = 1e-3};
    const auto per_second = static_cast<std::size_t>(rate_hz);
    const auto readings = gyro_at_rest(params, 4000 * per_second, 1);
    EXPECT_NEAR(allan_deviation(readings, per_second) / 1e-3, 1, allan_tolerance(4000));
    EXPECT_NEAR(allan_deviation(readings, 4 * per_second) / 0.5e-3, 1, allan_tolerance(1000));
  }
}

// One gyro with all three: the bottom shows between the slopes.
TEST(ImuAllanDeviation, ShowsNoiseInstabilityAndWalkAsStated) {
  const double noise = 1e-3, instability = 1e-3, walk = 2e-5;
  const ImuParams params{.rate_hz = 20,
                         .gyro_noise_radps_rthz = noise,
                         .gyro_instability_radps = instability,
                         .gyro_walk_radps_rts = walk};
  const auto readings = gyro_at_rest(params, 1'000'000, 3);  // 14 hours
  for (const std::size_t tau_s : {1u, 10u, 30u, 100u, 300u, 1000u}) {
    const double tau = static_cast<double>(tau_s);
    const double expected =
        std::sqrt(noise * noise / tau + std::pow(0.664 * instability, 2) + walk * walk * tau / 3);
    const double ratio = allan_deviation(readings, 20 * tau_s) / expected;
    // A tenth for the sum of Gauss-Markov processes, the rest for the estimate.
    EXPECT_NEAR(ratio, 1, 0.1 + allan_tolerance(50000 / tau_s)) << tau << " s";
    RecordProperty("ratio_at_" + std::to_string(tau_s) + "_s", std::to_string(ratio));
  }
}

// Second differences of where the IMU is in the world, turned into its frame.
TEST(ImuLeverArm, ReadsWhatItsPositionSaysWhenDifferentiatedTwice) {
  ImuParams params = kHonest;
  params.x_m = 0.4;
  params.y_m = -0.25;
  params.yaw_deg = 70;
  const double step_s = 1e-3;
  ImuModel2d imu(params, {}, step_s, Rng(1));
  const Pose2 T_base_imu(0.4, -0.25, 70 * std::numbers::pi / 180);
  std::vector<DriveState> states{cruising(0.5)};
  for (int k = 1; k <= 6000; ++k) {
    const double time_s = k * step_s;
    DriveState next = cruising(0.5 + 0.3 * std::sin(2 * time_s), 0.9 * std::sin(1.5 * time_s));
    const DriveState& last = states.back();
    next.T_world_base =
        last.T_world_base.plus({0.5 * (last.speed_mps + next.speed_mps) * step_s, 0,
                                0.5 * (last.yaw_rate_radps + next.yaw_rate_radps) * step_s});
    states.push_back(next);
  }
  const auto imu_at = [&](std::size_t k) { return states[k].T_world_base * T_base_imu; };
  double most_rotational_mps2 = 0;
  for (std::size_t k = 1; k + 1 < states.size(); ++k) {
    const ImuSample sample = imu.measure(states[k - 1], states[k], {});
    const Eigen::Vector2d accel_world =
        (imu_at(k + 1).translation_m() - 2 * imu_at(k).translation_m() +
         imu_at(k - 1).translation_m()) /
        (step_s * step_s);
    const Eigen::Vector2d expected = imu_at(k).rotation().transpose() * accel_world;
    // The reading's differences lie half a step before: jerks of at most 3 m/s3 times a step.
    EXPECT_NEAR(sample.accel_x_mps2, expected.x(), 3e-3) << k;
    EXPECT_NEAR(sample.accel_y_mps2, expected.y(), 3e-3) << k;
    const double rate = states[k].yaw_rate_radps;
    most_rotational_mps2 = std::max(most_rotational_mps2, rate * rate * std::hypot(0.4, 0.25));
  }
  EXPECT_GT(most_rotational_mps2, 0.3);  // a hundred times the tolerance
}

TEST(ImuLeverArm, CentripetalAndEulerTermsAreThoseOfTheHandbook) {
  ImuParams params = kHonest;
  params.x_m = 0.5;
  params.y_m = 0.2;
  ImuModel2d imu(params, {}, 0.1, Rng(1));
  // Turning on the spot: angular acceleration 2 rad/s2, at the end 1.2 rad/s.
  const ImuSample sample = imu.measure(cruising(0, 1.0), cruising(0, 1.2), {});
  EXPECT_NEAR(sample.accel_x_mps2, -2 * 0.2 - 1.44 * 0.5, kExact);
  EXPECT_NEAR(sample.accel_y_mps2, 2 * 0.5 - 1.44 * 0.2, kExact);
  EXPECT_NEAR(sample.gyro_z_radps, 1.2, kExact);
}

TEST(Imu, ScaleAndMisalignmentActOnTheTruth) {
  const double off_rad = 0.02;
  const ImuErrors errors{.gyro_bias_radps = 0.1,
                         .gyro_scale = 1.03,
                         .accel_scale_x = 0.9,
                         .accel_scale_y = 1.1,
                         .misalignment_rad = off_rad};
  ImuModel2d imu(kHonest, errors, 0.02, Rng(1));
  const ImuSample sample = imu.measure(cruising(0.40, 0.5), cruising(0.41, 0.5), {});
  EXPECT_NEAR(sample.gyro_z_radps, 1.03 * 0.5 + 0.1, kExact);
  // Truth in the base: (0.5, 0.205) m/s2.
  EXPECT_NEAR(sample.accel_x_mps2, 0.9 * (0.5 * std::cos(off_rad) + 0.205 * std::sin(off_rad)),
              kExact);
  EXPECT_NEAR(sample.accel_y_mps2, 1.1 * (0.205 * std::cos(off_rad) - 0.5 * std::sin(off_rad)),
              kExact);
}

// At even speed on a straight way nothing but gravity shows.
TEST(FloorTilt, LeaksGravityTimesItsSineAndChangesOverItsLength) {
  ImuParams params = kHonest;
  params.tilt_sigma_deg = 1;
  params.tilt_length_m = 2;
  const double step_s = 0.1;
  std::vector<double> begin, end;
  double product = 0;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    ImuModel2d imu(params, {}, step_s, Rng(seed));
    begin.push_back(imu.measure(cruising(0.5), cruising(0.5), {}).accel_x_mps2);
    for (int k = 0; k < 40; ++k) {  // 2 m
      const ImuSample sample = imu.measure(cruising(0.5), cruising(0.5), {});
      if (k == 39) end.push_back(sample.accel_x_mps2);
    }
    product += begin.back() * end.back();
  }
  const double sigma_mps2 = 9.80665 * std::sin(std::numbers::pi / 180);
  EXPECT_NEAR(standard_deviation(begin), sigma_mps2, sigma_mps2 * five_sigma(begin.size()));
  EXPECT_NEAR(standard_deviation(end), sigma_mps2, sigma_mps2 * five_sigma(end.size()));
  // A correlation of 1/e; its estimate has a standard error of (1 - 1/e^2) / sqrt(n).
  EXPECT_NEAR(product / 4000 / (sigma_mps2 * sigma_mps2), std::exp(-1.0),
              5 * std::sqrt((1 + std::exp(-2.0)) / 4000));
}

// The slope stays where it is while the robot turns on it: in the world its gravity is the same.
TEST(FloorTilt, BelongsToTheFloorAndTurnsAgainstARobotThatTurnsOnTheSpot) {
  ImuParams params = kHonest;
  params.tilt_sigma_deg = 1;
  ImuModel2d imu(params, {}, 0.1, Rng(4));
  const ImuSample first = imu.measure(cruising(0), cruising(0), {});
  const Eigen::Vector2d in_world(first.accel_x_mps2, first.accel_y_mps2);
  ASSERT_GT(in_world.norm(), 0.01);
  for (const double heading_deg : {30.0, 90.0, 180.0, 300.0}) {
    DriveState turned = cruising(0);
    turned.T_world_base = Pose2(0, 0, heading_deg * std::numbers::pi / 180);
    const ImuSample sample = imu.measure(turned, turned, {});
    const Eigen::Vector2d expected = turned.T_world_base.rotation().transpose() * in_world;
    EXPECT_NEAR(sample.accel_x_mps2, expected.x(), kExact) << heading_deg;
    EXPECT_NEAR(sample.accel_y_mps2, expected.y(), kExact) << heading_deg;
  }
}

// Reading = scale x truth + bias, to the last bit but rounding, where nothing is white.
TEST(Imu, BiasIsAllThatIsAddedToTheTruth) {
  ImuParams params = kHonest;
  params.gyro_instability_radps = params.gyro_walk_radps_rts = 0.01;
  params.accel_instability_mps2 = params.accel_walk_mps2_rts = 0.1;
  params.tilt_sigma_deg = 1;
  params.yaw_deg = 40;
  const ImuErrors errors{.gyro_bias_radps = 0.1,
                         .accel_bias_x_mps2 = 0.2,
                         .accel_bias_y_mps2 = 0.3,
                         .accel_scale_x = 0.9,
                         .accel_scale_y = 1.1};
  ImuModel2d imu(params, errors, kStep_s, Rng(1));
  EXPECT_TRUE(imu.has_varying_bias());
  EXPECT_FALSE(ImuModel2d(kHonest, errors, kStep_s, Rng(1)).has_varying_bias());
  for (int k = 0; k < 100; ++k) {
    const ImuSample sample = imu.measure(cruising(0.5), cruising(0.5), {});
    EXPECT_NEAR(sample.gyro_z_radps, imu.bias().gyro_radps, kExact);
    EXPECT_NEAR(sample.accel_x_mps2, imu.bias().accel_x_mps2, kExact);
    EXPECT_NEAR(sample.accel_y_mps2, imu.bias().accel_y_mps2, kExact);
  }
}

TEST(Imu, VibrationGrowsWithTheSpeedAndIsAbsentAtRest) {
  ImuParams params = kHonest;
  params.vibration_mps2 = 0.4;
  for (const double speed_mps : {0.0, 0.25, 1.0}) {
    ImuModel2d imu(params, {}, kStep_s, Rng(2));
    std::vector<double> readings;
    for (int k = 0; k < 5000; ++k) {
      readings.push_back(imu.measure(cruising(speed_mps), cruising(speed_mps), {}).accel_y_mps2);
    }
    const double sigma_mps2 = 0.4 * speed_mps;
    EXPECT_NEAR(standard_deviation(readings), sigma_mps2, sigma_mps2 * five_sigma(5000));
  }
}

}  // namespace
}  // namespace corridor::simulation::testing
