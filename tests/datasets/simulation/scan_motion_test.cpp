// Scans that take time: what the robot's motion does to them, and that it can be taken out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "datasets/simulation/lidar_model.hpp"
#include "datasets/simulation/simulate.hpp"
#include "slam/motion/deskew.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

constexpr double kFloat_m = 1e-6;  // ranges of some metres are stored as float

// Seen from the middle of a wall 5 m ahead, within 45 degrees to either side.
class SweepOfAWall : public ::testing::Test {
 protected:
  LaserScan scan_while(const Pose2::Tangent& twist) const {
    const LidarModel lidar(world_, params_);
    return lidar.measure(lidar.sweep([&](double time_s) { return Pose2::exp(twist * time_s); }, {}),
                         Rng(1));
  }
  const World world_ = world_of({{{5, -40}, {5, 40}}});
  LidarParams params_{.num_beams = 181,
                      .field_of_view_deg = 90,
                      .range_max_m = 20,
                      .range_sigma_m = 0,
                      .scan_duration_s = 0.09};
};

TEST_F(SweepOfAWall, TakesEachBeamAShareOfTheDurationLater) {
  const LaserScan scan = scan_while({0, 0, 0});
  EXPECT_EQ(scan.duration_s, 0.09);
  EXPECT_EQ(scan.beam_time_s(0), 0);
  EXPECT_NEAR(scan.beam_time_s(180), 0.09, 1e-12);
}

TEST_F(SweepOfAWall, StraightDriveTowardsItShortensEachBeamByWhatTheRobotDrove) {
  const LaserScan scan = scan_while({1.5, 0, 0});
  for (std::size_t i = 0; i < scan.num_beams(); ++i) {
    const double driven_m = 1.5 * 0.09 * static_cast<double>(i) / 180;
    EXPECT_NEAR(scan.ranges_m[i], (5 - driven_m) / std::cos(scan.angle_rad(i)), kFloat_m);
  }
}

TEST_F(SweepOfAWall, TurningOnTheSpotMeetsItWhereTheTurnedBeamPoints) {
  const LaserScan scan = scan_while({0, 0, 2.0});
  for (std::size_t i = 0; i < scan.num_beams(); ++i) {
    const double turned_rad = 2.0 * 0.09 * static_cast<double>(i) / 180;
    EXPECT_NEAR(scan.ranges_m[i], 5 / std::cos(scan.angle_rad(i) + turned_rad), kFloat_m);
  }
}

TEST_F(SweepOfAWall, DeskewingWithTheTrueTwistPutsThePointsBackOnTheWall) {
  params_.x_m = 0.3;
  params_.y_m = 0.1;
  params_.yaw_deg = 10;
  const Pose2::Tangent twist(0.8, 0.05, 0.9);
  const LaserScan scan = scan_while(twist);
  const auto points_m = motion::deskewed_points(scan, twist, 20);
  ASSERT_EQ(points_m.size(), 181u);
  double most_skewed_m = 0;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    EXPECT_NEAR(points_m[i].x(), 5, kFloat_m);
    most_skewed_m = std::max(most_skewed_m, std::abs(scan.point_base_m(i).x() - 5));
  }
  EXPECT_GT(most_skewed_m, 0.1);
}

// From a log, with the truth at the scan and the even turn of a robot that spins.
TEST(SimulatedSweep, OfASpinningRobotIsDeskewedOntoTheWallsOfTheWorld) {
  Scenario scenario;
  scenario.lidar.range_sigma_m = 0;
  scenario.lidar.scan_duration_s = 0.08;
  scenario.drive.spin_turns = 1;
  scenario.drive.stays = true;
  const Simulated simulated = simulated_log(scenario, 1);
  std::size_t scan_index = 0;
  int num_tested = 0;
  double most_skewed_m = 0;
  for (const SensorEvent& event : simulated.log.events) {
    const auto* scan = std::get_if<LaserScan>(&event);
    if (scan == nullptr) continue;
    const Pose2 T_world_base = (*simulated.log.truth)[scan_index++].T_map_base;
    const double time_s = to_seconds(scan->stamp);
    if (time_s < 1 || time_s > 6) continue;  // speeds up and brakes within 0.2 s of 8 s
    ++num_tested;
    for (const auto& point_m :
         motion::deskewed_points(*scan, {0, 0, scenario.drive.yaw_rate_max_radps}, 10)) {
      EXPECT_LT(clearance_m(simulated.world, T_world_base * point_m), kFloat_m);
    }
    for (std::size_t i = 0; i < scan->num_beams(); ++i) {
      if (!scan->is_valid[i]) continue;
      most_skewed_m = std::max(most_skewed_m,
                               clearance_m(simulated.world, T_world_base * scan->point_base_m(i)));
    }
  }
  EXPECT_GE(num_tested, 50);
  EXPECT_GT(most_skewed_m, 0.1);
}

}  // namespace
}  // namespace corridor::simulation::testing
