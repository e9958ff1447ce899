// Every error of the wheels, found in recorded logs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/datasets/simulation/from_log_support.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

constexpr double kTrack_m = 0.35;

Scenario with_wheels(Scenario scenario, const std::function<void(WheelParams&)>& set) {
  set(scenario.wheels);
  return scenario;
}

Scenario short_drive(const std::function<void(WheelParams&)>& set) {
  Scenario scenario = with_wheels(honest_scenario(), set);
  scenario.world.route_m[1].x() = 2;  // with ticks of 1e-6 m, enough for scales to 1e-6
  return scenario;
}

double scale(const RecordedRun& run) {
  return counted_between_scans_m(run, counted(run).common_m) / driven_m(run);
}
double unbalance(const RecordedRun& run) {  // (left - right) / 2
  return -0.5 * counted_between_scans_m(run, counted(run).difference_m) / driven_m(run);
}
double track(const RecordedRun& run) {
  return counted_between_scans_m(run, counted(run).difference_m) / turned_rad(run) / kTrack_m;
}

TEST(WheelSpread, OfScaleAndUnbalanceOverLogsIsTheStatedOne) {
  const Scenario scenario = short_drive([](auto& p) {
    p.scale_sigma = 0.02;
    p.unbalance_sigma = 0.01;
  });
  expect_spreads(scenario, {{"scale", scale, 1, 0.02}, {"unbalance", unbalance, 0, 0.01}});
}

TEST(WheelSpread, OfTheTrackOverLogsIsTheStatedOne) {
  expect_spreads(with_wheels(honest_stay(0.2, 1), [](auto& p) { p.track_sigma = 0.02; }),
                 {{"track", track, 1, 0.02}});
}

TEST(WheelsFromLogs, TicksHaveTheStatedLength) {
  const RecordedRun run =
      recorded(with_wheels(honest_scenario(), [](auto& p) { p.m_per_tick = 0.01; }), 1);
  const auto samples = readings<WheelSample>(run.log);
  const double path_m = run.log.truth->poses().back().T_map_base.x_m();
  // The last scan lies less than 0.1 s before the end.
  EXPECT_NEAR(path_m / static_cast<double>(samples.back().ticks->left), 0.01, 0.01 * 0.15 / path_m);
}

// Increments of 1 m/s over 20 ms: four times 5 ms with noise of their own make half of the part,
// whether the simulator takes one step, four or sixteen.
TEST(WheelsFromLogs, NoiseIsTheStatedPartOfEach5MillisecondsAtEveryRateOfTheImu) {
  for (const double imu_rate_hz : {50.0, 200.0, 800.0}) {
    Scenario scenario = with_wheels(honest_scenario(), [](auto& p) { p.noise_ratio = 0.05; });
    scenario.imu.rate_hz = imu_rate_hz;
    const RecordedRun run = recorded(scenario, 1);
    const Counted wheels = counted(run);
    std::vector<double> steps_m;  // of the left wheel
    for (std::size_t i = 150; i < wheels.common_m.size(); ++i) {
      steps_m.push_back(wheels.common_m[i] - wheels.common_m[i - 1] -
                        0.5 * (wheels.difference_m[i] - wheels.difference_m[i - 1]));
    }
    EXPECT_NEAR(standard_deviation(steps_m) / mean(steps_m) / 0.025, 1,
                four_sigma(static_cast<double>(steps_m.size())))
        << imu_rate_hz;
    // 0.05 * sqrt(5 mm) per root metre.
    EXPECT_NEAR(run.log.robot.wheels.sigma_m_per_sqrt_m, 0.05 * std::sqrt(0.005), 1e-12);
  }
}

TEST(WheelsFromLogs, SlipsHaveTheStatedRatioAndFillTheStatedShare) {
  Scenario scenario = honest_scenario();
  scenario.lidar.rate_hz = 50;
  scenario.slip = {.share = 0.2, .duration_s = 0.5, .ratio = 0.4};
  const RecordedRun run = recorded(scenario, 1);
  const Counted wheels = counted(run);
  const auto& poses = run.log.truth->poses();
  ASSERT_EQ(poses.size(), wheels.common_m.size());
  std::vector<double> ratios;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const double true_m = poses[i].T_map_base.x_m() - poses[i - 1].T_map_base.x_m();
    if (true_m < 1e-4) continue;  // ticks of a micrometre: a hundredth
    ratios.push_back((wheels.common_m[i] - wheels.common_m[i - 1]) / true_m - 1);
  }
  const auto slipping = [](double ratio) { return ratio > 0.2; };
  const auto num_slipping = std::count_if(ratios.begin(), ratios.end(), slipping);
  // Half a slip of 50 s.
  EXPECT_NEAR(static_cast<double>(num_slipping) / static_cast<double>(ratios.size()), 0.2, 0.01);
  std::sort(ratios.begin(), ratios.end());
  EXPECT_NEAR(ratios[ratios.size() - static_cast<std::size_t>(num_slipping) / 2], 0.4, 1e-3);
  EXPECT_NEAR(ratios[ratios.size() / 2], 0, 1e-3);
}

}  // namespace
}  // namespace corridor::simulation::testing
