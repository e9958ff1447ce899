// The world that a seed draws, found in recorded logs.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/datasets/simulation/from_log_support.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

// The honest robot in the paper's corridor.
Scenario corridor_drive(const std::function<void(Scenario&)>& set) {
  Scenario scenario = honest_scenario();
  scenario.world = make_corridor({});
  scenario.drive.speed_min_mps = scenario.drive.speed_max_mps = 0.6;
  set(scenario);
  return scenario;
}

Scenario corridor_stay() {
  return corridor_drive([](Scenario& s) {
    s.draw.length_spread = 0.1;
    s.drive.stays = true;
    s.drive.stand_s = 0.2;
  });
}

// Of a uniform number, -half_range to half_range.
double sigma_of(double half_range) { return half_range / std::sqrt(3.0); }

// The robot looks along the first arm: two of its four beams meet the two walls at 45 deg, ahead.
double width_m(const RecordedRun& run) {
  const LaserScan scan = readings<LaserScan>(run.log).front();
  return (scan.ranges_m[1] + scan.ranges_m[2]) / std::numbers::sqrt2;
}

// Of the way that it drives at last, against the first arm.
double alpha_deg(const RecordedRun& run) {
  const auto& poses = run.log.truth->poses();
  const Eigen::Vector2d way_m =
      poses.back().T_map_base.translation_m() - poses[poses.size() - 20].T_map_base.translation_m();
  return 180 - std::atan2(way_m.y(), way_m.x()) * 180 / std::numbers::pi;
}

class WorldSpread : public ::testing::TestWithParam<SpreadCase> {};
TEST_P(WorldSpread, OverLogsIsTheStatedOne) { expect_spread(GetParam()); }
INSTANTIATE_TEST_SUITE_P(
    FromLogs, WorldSpread,
    ::testing::Values(
        SpreadCase{"Width", corridor_stay(), width_m, 5, 5 * sigma_of(0.1)},
        SpreadCase{"FirstArm", corridor_stay(),
                   [](const RecordedRun& run) { return run.truth.world.corridor->b_m; }, 21,
                   21 * sigma_of(0.1)},
        SpreadCase{"SecondArm", corridor_stay(),
                   [](const RecordedRun& run) { return run.truth.world.corridor->a_m; }, 14.5,
                   14.5 * sigma_of(0.1)},
        SpreadCase{"Alpha", corridor_drive([](Scenario& s) {
                     s.world = make_corridor({.a_m = 12, .b_m = 12});
                     s.draw.alpha_spread_deg = 20;
                   }),
                   alpha_deg, 90, sigma_of(20)}),
    [](const auto& given) { return given.param.name; });

}  // namespace
}  // namespace corridor::simulation::testing
