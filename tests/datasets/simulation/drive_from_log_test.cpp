// The drive that a seed draws, found in the true poses of recorded logs.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/datasets/simulation/from_log_support.hpp"

namespace corridor::simulation::testing {
namespace {

constexpr double kWay_m = 4;

// Stands until the first scan, so that it shows the start; soon at its speed, soon on its line.
Scenario drawn_drive() {
  Scenario scenario = honest_scenario();
  scenario.world.route_m[1].x() = kWay_m;
  DriveParams& drive = scenario.drive;
  drive.stand_s = 1 / scenario.lidar.rate_hz;
  drive.acceleration_mps2 = 10;
  drive.heading_gain_per_s = 10;
  drive.yaw_rate_max_radps = 10;
  drive.speed_min_mps = 1;
  drive.speed_max_mps = 2;
  drive.start_spread_m = 0.3;
  drive.heading_spread_deg = 20;
  drive.lateral_spread_m = 0.4;
  return scenario;
}

double start_x_m(const RecordedRun& run) { return run.log.truth->poses().front().T_map_base.x_m(); }
double start_y_m(const RecordedRun& run) { return run.log.truth->poses().front().T_map_base.y_m(); }
double heading_deg(const RecordedRun& run) {
  return run.log.truth->poses().front().T_map_base.theta_rad() * 180 / std::numbers::pi;
}

double speed_mps(const RecordedRun& run) {
  const auto& last = run.log.truth->poses().back();
  const auto& before = *(run.log.truth->poses().end() - 2);
  return (last.T_map_base.translation_m() - before.T_map_base.translation_m()).norm() /
         seconds_between(before.stamp, last.stamp);
}

// The robot heads for its waypoint, which was moved across the route.
double waypoint_y_m(const RecordedRun& run) {
  const Pose2& T_map_base = run.log.truth->poses().back().T_map_base;
  return T_map_base.y_m() + (kWay_m - T_map_base.x_m()) * std::tan(T_map_base.theta_rad());
}

TEST(DriveSpread, OfStartSpeedAndWaypointOverLogsIsTheStatedOne) {
  expect_spreads(drawn_drive(), {{"start x", start_x_m, 0, uniform_sigma(0.3)},
                                 {"start y", start_y_m, 0, uniform_sigma(0.3)},
                                 {"heading", heading_deg, 0, uniform_sigma(20)},
                                 {"speed", speed_mps, 1.5, uniform_sigma(0.5)},
                                 {"waypoint y", waypoint_y_m, 0, uniform_sigma(0.4)}});
}

}  // namespace
}  // namespace corridor::simulation::testing
