// Every error of the IMU, found in recorded logs.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "tests/datasets/simulation/from_log_support.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr double kGravity_mps2 = 9.80665;

enum Channel { kGyro, kAccelX, kAccelY };

std::vector<double> channel(const SensorLog& log, Channel which) {
  std::vector<double> values;
  for (const ImuSample& sample : readings<ImuSample>(log)) {
    values.push_back(which == kGyro     ? sample.gyro_z_radps
                     : which == kAccelX ? sample.accel_x_mps2
                                        : sample.accel_y_mps2);
  }
  return values;
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

// Bias = mean at rest.
auto mean_of(Channel which) {
  return [which](const RecordedRun& run) { return mean(channel(run.log, which)); };
}

// Rates between the scans' stamps, by trapezes, over the true turn.
double gyro_scale(const RecordedRun& run) {
  const double begin_s = to_seconds(run.log.truth->poses().front().stamp);
  const double end_s = to_seconds(run.log.truth->poses().back().stamp);
  const auto samples = readings<ImuSample>(run.log);
  double sum_rad = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double from_s = to_seconds(samples[i - 1].stamp), to_s = to_seconds(samples[i].stamp);
    if (from_s < begin_s - 1e-6 || to_s > end_s + 1e-6) continue;
    sum_rad += 0.5 * (samples[i - 1].gyro_z_radps + samples[i].gyro_z_radps) * (to_s - from_s);
  }
  return sum_rad / turned_rad(run);
}

// What an IMU at (0.5, 0.5) m feels while the robot turns on the spot, by the gyro's own rates.
struct LeverForces {
  std::vector<Vector2d> expected, read;
};
LeverForces lever_forces(const RecordedRun& run) {
  LeverForces forces;
  const auto samples = readings<ImuSample>(run.log);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double rate = samples[i].gyro_z_radps;
    const double change = (rate - samples[i - 1].gyro_z_radps) /
                          seconds_between(samples[i - 1].stamp, samples[i].stamp);
    forces.expected.emplace_back(-0.5 * (rate * rate + change), -0.5 * (rate * rate - change));
    forces.read.emplace_back(samples[i].accel_x_mps2, samples[i].accel_y_mps2);
  }
  return forces;
}

// What the accelerometer makes of the force, 2x2: its scales times the turn back by its
// misalignment.
Matrix2d accel_matrix(const RecordedRun& run) {
  const LeverForces forces = lever_forces(run);
  Matrix2d products = Matrix2d::Zero(), squares = Matrix2d::Zero();
  for (std::size_t i = 0; i < forces.read.size(); ++i) {
    products += forces.read[i] * forces.expected[i].transpose();
    squares += forces.expected[i] * forces.expected[i].transpose();
  }
  return products * squares.inverse();
}

auto accel_scale(int axis) {
  return [axis](const RecordedRun& run) { return accel_matrix(run).row(axis).norm(); };
}
double misalignment_rad(const RecordedRun& run) {
  const Matrix2d matrix = accel_matrix(run);
  return std::atan2(matrix(0, 1), matrix(0, 0));
}

Scenario with_imu(Scenario scenario, const std::function<void(ImuParams&)>& set) {
  set(scenario.imu);
  return scenario;
}

Scenario lever_spin(const std::function<void(ImuParams&)>& set) {
  Scenario scenario = with_imu(honest_stay(0.2, 1), set);
  scenario.imu.x_m = scenario.imu.y_m = 0.5;
  return scenario;
}

TEST(ImuSpread, OfBiasesOverLogsIsTheStatedOne) {
  const Scenario scenario = with_imu(honest_stay(0.2), [](auto& p) {
    p.gyro_bias_sigma_radps = 0.01;
    p.accel_bias_sigma_mps2 = 0.1;
  });
  expect_spreads(scenario, {{"gyro", mean_of(kGyro), 0, 0.01},
                            {"accel x", mean_of(kAccelX), 0, 0.1},
                            {"accel y", mean_of(kAccelY), 0, 0.1}});
}

TEST(ImuSpread, OfTheTiltOverLogsIsTheStatedOne) {
  const double sigma_mps2 = kGravity_mps2 * std::sin(kRadPerDeg);
  expect_spreads(
      with_imu(honest_stay(0.2), [](auto& p) { p.tilt_sigma_deg = 1; }),
      {{"tilt x", mean_of(kAccelX), 0, sigma_mps2}, {"tilt y", mean_of(kAccelY), 0, sigma_mps2}});
}

TEST(ImuSpread, OfTheGyroScaleOverLogsIsTheStatedOne) {
  expect_spreads(with_imu(honest_stay(0.2, 1), [](auto& p) { p.gyro_scale_sigma = 0.02; }),
                 {{"gyro scale", gyro_scale, 1, 0.02}});
}

TEST(ImuSpread, OfAccelScalesAndMisalignmentOverLogsIsTheStatedOne) {
  const Scenario scenario = lever_spin([](auto& p) {
    p.accel_scale_sigma = 0.02;
    p.misalignment_sigma_deg = 1;
  });
  expect_spreads(scenario, {{"accel scale x", accel_scale(0), 1, 0.02},
                            {"accel scale y", accel_scale(1), 1, 0.02},
                            {"misalignment", misalignment_rad, 0, kRadPerDeg}});
}

// An hour at rest, once more for each seed.
std::vector<RecordedRun> hours(const std::function<void(ImuParams&)>& set, std::uint64_t num_logs) {
  Scenario scenario = with_imu(honest_stay(3600), set);
  scenario.imu.rate_hz = 10;
  scenario.lidar.rate_hz = scenario.wheels.rate_hz = 0.1;
  std::vector<RecordedRun> runs;
  for (std::uint64_t seed = 1; seed <= num_logs; ++seed) runs.push_back(recorded(scenario, seed));
  return runs;
}

double allan_deviation_at(const std::vector<RecordedRun>& runs, Channel which, double tau_s) {
  std::vector<double> deviations;
  for (const RecordedRun& run : runs) {
    deviations.push_back(
        allan_deviation(channel(run.log, which), static_cast<std::size_t>(tau_s * 10)));
  }
  return root_mean_square(deviations);
}

// Four standard errors, each 1 / sqrt(n) of the deviation at most.
double allan_interval(std::size_t num_logs, double tau_s) {
  return 4 / std::sqrt(static_cast<double>(num_logs) * 3600 / tau_s);
}

TEST(ImuFromLogs, WhiteNoiseHasTheStatedDensity) {
  const auto runs = hours(
      [](ImuParams& p) {
        p.gyro_noise_radps_rthz = 1e-3;
        p.accel_noise_mps2_rthz = 5e-3;
      },
      1);
  for (const auto& [which, density] : {std::pair{kGyro, 1e-3}, {kAccelX, 5e-3}, {kAccelY, 5e-3}}) {
    EXPECT_NEAR(allan_deviation_at(runs, which, 1) / density, 1, allan_interval(1, 1)) << which;
    EXPECT_NEAR(standard_deviation(channel(runs[0].log, which)) / (density * std::sqrt(10.0)), 1,
                four_sigma(36000));
  }
}

// White noise would fall by a factor of 3.2 from 3 s to 30 s, a walk rise by as much.
TEST(ImuFromLogs, InstabilityIsTheFlatBottomOfTheAllanDeviation) {
  const auto runs = hours(
      [](ImuParams& p) {
        p.gyro_instability_radps = 1e-3;
        p.accel_instability_mps2 = 5e-3;
      },
      4);
  for (const auto& [which, stated] : {std::pair{kGyro, 1e-3}, {kAccelX, 5e-3}, {kAccelY, 5e-3}}) {
    for (const double tau_s : {3.0, 10.0, 30.0}) {
      // 0.664 B within a tenth.
      EXPECT_NEAR(allan_deviation_at(runs, which, tau_s) / (0.664 * stated), 1,
                  0.1 + allan_interval(4, tau_s))
          << which << " at " << tau_s;
    }
  }
}

// At 60 s the walk of K is K sqrt(tau / 3); the white noise would be a hundredth of that.
TEST(ImuFromLogs, WalkIsTheRisingSlopeOfTheAllanDeviation) {
  const auto runs = hours(
      [](ImuParams& p) {
        p.gyro_noise_radps_rthz = 3e-5;
        p.gyro_walk_radps_rts = 1e-4;
        p.accel_noise_mps2_rthz = 3e-4;
        p.accel_walk_mps2_rts = 1e-3;
      },
      3);
  for (const auto& [which, stated] : {std::pair{kGyro, 1e-4}, {kAccelX, 1e-3}, {kAccelY, 1e-3}}) {
    const double expected = stated * std::sqrt(60 / 3.0);
    EXPECT_NEAR(allan_deviation_at(runs, which, 60) / expected, 1, allan_interval(3, 60)) << which;
  }
}

TEST(ImuFromLogs, SidecarsBiasIsWhatTheReadingsHave) {
  const auto runs = hours(
      [](ImuParams& p) {
        p.gyro_walk_radps_rts = 1e-4;
        p.accel_walk_mps2_rts = 1e-3;
        p.gyro_bias_sigma_radps = 0.01;
        p.tilt_sigma_deg = 1;
      },
      1);
  const auto samples = readings<ImuSample>(runs[0].log);
  ASSERT_EQ(runs[0].truth.imu_bias.size(), 3600u);
  for (std::size_t i = 0; i < 3600; ++i) {
    const ImuBiasSample& truth = runs[0].truth.imu_bias[i];
    const ImuSample& sample = samples[10 * i + 9];
    EXPECT_NEAR(to_seconds(sample.stamp), truth.stamp_s, 1e-6);
    EXPECT_NEAR(sample.gyro_z_radps, truth.bias.gyro_radps, 1e-12);
    EXPECT_NEAR(sample.accel_x_mps2, truth.bias.accel_x_mps2, 1e-12);
    EXPECT_NEAR(sample.accel_y_mps2, truth.bias.accel_y_mps2, 1e-12);
  }
}

// Readings while the robot cruises at 1 m/s along +x, where the truth is zero.
std::vector<double> while_cruising(const RecordedRun& run, Channel which) {
  const std::vector<double> all = channel(run.log, which);
  return {all.begin() + 150, all.end()};  // 3 s: 2 s of 0.5 m/s2, and some
}

TEST(ImuFromLogs, VibrationIsTheStatedOneOnBothAxes) {
  const RecordedRun run =
      recorded(with_imu(honest_scenario(), [](auto& p) { p.vibration_mps2 = 0.3; }), 1);
  for (const Channel which : {kAccelX, kAccelY}) {
    const auto values = while_cruising(run, which);
    EXPECT_NEAR(standard_deviation(values) / 0.3, 1,
                four_sigma(static_cast<double>(values.size())));
  }
}

TEST(ImuFromLogs, VibrationGrowsWithSpeedFromNothingAtRest) {
  const auto shaken = [](Scenario scenario) {
    return with_imu(std::move(scenario), [](auto& p) { p.vibration_mps2 = 0.3; });
  };
  for (const double speed_mps : {0.25, 0.5}) {
    Scenario scenario = shaken(honest_scenario());
    scenario.drive.speed_min_mps = scenario.drive.speed_max_mps = speed_mps;
    const auto values = while_cruising(recorded(scenario, 1), kAccelX);
    EXPECT_NEAR(standard_deviation(values) / (0.3 * speed_mps), 1,
                four_sigma(static_cast<double>(values.size())))
        << speed_mps;
  }
  const RecordedRun at_rest = recorded(shaken(honest_stay(10)), 1);
  EXPECT_EQ(root_mean_square(channel(at_rest.log, kAccelX)), 0);
}

TEST(ImuFromLogs, TiltChangesOverItsLengthOnBothAxes) {
  const Scenario scenario = with_imu(honest_scenario(), [](auto& p) {
    p.tilt_sigma_deg = 1;
    p.tilt_length_m = 0.25;
  });
  for (const Channel which : {kAccelX, kAccelY}) {
    std::vector<double> products, squares;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const auto values = while_cruising(recorded(scenario, seed), which);
      const std::size_t lag = 12;  // 0.24 m at 1 m/s and 50 Hz
      for (std::size_t i = lag; i < values.size(); ++i) {
        products.push_back(values[i] * values[i - lag]);
        squares.push_back(values[i] * values[i]);
      }
    }
    const double num_lengths = static_cast<double>(squares.size()) * 0.02 / 0.25;
    const double sigma_mps2 = kGravity_mps2 * std::sin(kRadPerDeg);
    EXPECT_NEAR(std::sqrt(mean(squares)) / sigma_mps2, 1, four_sigma(num_lengths));
    EXPECT_NEAR(mean(products) / mean(squares), std::exp(-0.24 / 0.25), 4 / std::sqrt(num_lengths));
  }
}

TEST(ImuFromLogs, TiltOfTheFloorTurnsInTheReadingsOfARobotThatTurnsOnTheSpot) {
  const RecordedRun run =
      recorded(with_imu(honest_stay(1, 1.5), [](auto& p) { p.tilt_sigma_deg = 1; }), 1);
  Vector2d sum_world = Vector2d::Zero();
  double sum_mps2 = 0;
  for (const ImuSample& sample : readings<ImuSample>(run.log)) {
    const auto pose = run.log.truth->interpolate(sample.stamp);
    if (!pose) continue;
    const Vector2d read(sample.accel_x_mps2, sample.accel_y_mps2);
    sum_world += pose->rotation() * read;
    sum_mps2 += read.norm();
  }
  ASSERT_GT(sum_mps2, 0);
  EXPECT_GT(sum_world.norm() / sum_mps2, 0.999);
}

}  // namespace
}  // namespace corridor::simulation::testing
