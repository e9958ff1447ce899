// No accepted scenario drives through a wall, and none leads people through one.
#include "datasets/simulation/route.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/datasets/simulation/simulation_support.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::simulation::testing {
namespace {

using ::corridor::testing::ScratchFolder;
using Eigen::Vector2d;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::optional<TightSpot> tight_spot(const World& world, double needed_m) {
  return simulation::tight_spot(world, world.route_m,
                                std::vector<double>(world.route_m.size(), needed_m));
}

TEST(TightSpot, IsWhereAWallOrAnArcIsNearerThanNeeded) {
  World world = world_of({{{0, 1}, {10, 1}}});
  world.arcs.push_back({.centre_m = {5, -1}, .radius_m = 0.3});
  world.route_m = {{0, 0}, {10, 0}};
  EXPECT_FALSE(tight_spot(world, 0.69));
  const auto spot = tight_spot(world, 0.71);
  ASSERT_TRUE(spot);
  EXPECT_NEAR(spot->point_m.x(), 5, 1e-9);
  EXPECT_NEAR(spot->room_m, 0.7, 1e-9);
  world.arcs.clear();
  EXPECT_FALSE(tight_spot(world, 0.99));
  EXPECT_TRUE(tight_spot(world, 1.01));
}

TEST(TightSpot, IsTheTightestOfTheFirstLegThatLacksRoomHoweverFarTheWay) {
  World world =
      world_of({{{-99, 9}, {-98, 9}}, {{999.95, 0.3}, {999.95, 1}}, {{1500, 0}, {1500, 1}}});
  world.route_m = {{-1000, 0}, {0, 0}, {1200, 0}, {2000, 0}};
  const auto spot = tight_spot(world, 0.5);
  ASSERT_TRUE(spot);
  EXPECT_EQ(spot->leg, 1u);
  EXPECT_NEAR(spot->point_m.x(), 999.95, 0.026);
  EXPECT_NEAR(spot->room_m, 0.3, 1e-3);
}

TEST(TightSpot, OfASinglePointIsThatPoint) {
  World world = world_of({{{0, 1}, {10, 1}}});
  world.route_m = {{5, 0.9}};
  EXPECT_FALSE(tight_spot(world, 0.09));
  EXPECT_TRUE(tight_spot(world, 0.11));
}

TEST(TightSpot, NeedsWhatLiesBetweenTheNeedsOfItsEnds) {
  World world = world_of({{{0, 1}, {10, 1}}});
  world.route_m = {{0, 0}, {10, 0}};
  EXPECT_FALSE(simulation::tight_spot(world, world.route_m, {0.1, 0.99}));
  const auto spot = simulation::tight_spot(world, world.route_m, {0, 2});
  ASSERT_TRUE(spot);
  EXPECT_NEAR(spot->point_m.x(), 10, 1e-9);
  EXPECT_NEAR(spot->needed_m, 2, 1e-9);
}

TEST(TightSpot, IsWrittenWithNumbersThatDiffer) {
  EXPECT_EQ(to_text({.point_m = {1, 2}, .room_m = 1.0599999, .needed_m = 1.06}),
            "1.05 m from a wall at (1, 2); expected at least 1.06 m");
}

TEST(BlockedLeg, IsTheOneWithAWallInItsStrip) {
  const std::vector<Vector2d> route_m{{0, 0}, {10, 0}, {10, 10}};
  const World pillar = world_of({{{9, 5}, {9.2, 5}}});
  EXPECT_FALSE(blocked_leg(pillar, route_m, 0.79));
  EXPECT_EQ(blocked_leg(pillar, route_m, 0.81), 1u);
  EXPECT_EQ(blocked_leg(world_of({{{5, -9}, {5, 9}}}), route_m, 0.1), 0u);
  EXPECT_FALSE(blocked_leg(world_of({{{-1, -9}, {-1, 9}}}), route_m, 3));  // behind its end
}

// A tube around a random route, its half width a little above or below what the rules ask.
Scenario random_tube(Rng& rng) {
  Scenario scenario;
  DriveParams& drive = scenario.drive;
  drive.lateral_spread_m = rng.uniform(0, 2);
  drive.start_spread_m = rng.uniform(0, 0.5);
  drive.heading_spread_deg = rng.uniform(0, 30);
  drive.num_arm_waypoints = static_cast<int>(rng.below(3));
  drive.waypoint_reach_m = rng.uniform(0.1, 0.4);
  drive.is_return_trip = rng.uniform() < 0.3;
  scenario.lidar.num_beams = 4;
  scenario.lidar.rate_hz = 1;
  scenario.imu.rate_hz = 50;
  const double half_width_m = rng.uniform(0.6, 4);
  double heading_rad = 0;
  std::vector<Vector2d> left_m, right_m;
  World world;
  world.route_m = {{0, 0}};
  Vector2d at_m(0, 0);
  const auto add_cut = [&](double cut_rad, double stretch) {
    const Vector2d across(-std::sin(cut_rad), std::cos(cut_rad));
    left_m.push_back(at_m + stretch * half_width_m * across);
    right_m.push_back(at_m - stretch * half_width_m * across);
  };
  at_m = {-half_width_m - 1, 0};
  add_cut(0, 1);
  at_m = {0, 0};
  const auto num_legs = 1 + rng.below(3);
  for (std::size_t i = 0; i < num_legs; ++i) {
    const double length_m = rng.uniform(12, 20);
    at_m += length_m * Vector2d(std::cos(heading_rad), std::sin(heading_rad));
    world.route_m.push_back(at_m);
    if (i + 1 == num_legs) break;
    const double turn_rad = rng.uniform(-60, 60) * std::numbers::pi / 180;
    add_cut(heading_rad + 0.5 * turn_rad, 1 / std::cos(0.5 * turn_rad));
    heading_rad += turn_rad;
  }
  at_m += (half_width_m + 1) * Vector2d(std::cos(heading_rad), std::sin(heading_rad));
  add_cut(heading_rad, 1);
  std::vector<Vector2d> outline_m = left_m;
  outline_m.insert(outline_m.end(), right_m.rbegin(), right_m.rend());
  for (std::size_t i = 0; i < outline_m.size(); ++i) {
    world.walls.push_back({outline_m[i], outline_m[(i + 1) % outline_m.size()]});
  }
  scenario.world = world;
  return scenario;
}

// Whether simulate() then refuses any for its path is counted, not asserted.
RC_GTEST_PROP(Route, NoAcceptedScenarioDrivesThroughAWall, (std::uint64_t seed)) {
  Rng rng(seed);
  const Scenario scenario = random_tube(rng);
  const bool is_accepted = violations(scenario).empty();
  RC_CLASSIFY(is_accepted, "accepted");
  RC_PRE(is_accepted);
  for (std::uint64_t drawn = 0; drawn < 4; ++drawn) {
    const Result<Simulated> simulated = simulate(scenario, drawn);
    RC_CLASSIFY(!simulated, "refused for its path");
    if (!simulated) continue;
    for (const TrajectoryPose& pose : simulated->log.truth->poses()) {
      RC_ASSERT(clearance_m(scenario.world, pose.T_map_base.translation_m()) > 0.19);
    }
  }
}

TEST(Route, OffsetsAddUpWhereTheRouteHardlyBends) {
  const ScratchFolder folder;
  const auto path = folder.write(
      "bend.toml",
      "[world]\npolygons = [{ points_m = "
      "[[0,-2.7],[20,-2.7],[40,-0.95],[40,4.46],[20,2.7],[0,2.7]] }]\n"
      "route_m = [[3,0],[20,0],[37,1.487]]\n[drive]\nlateral_spread_m = 2.0\nstart_spread_m = 0.5\n"
      "heading_spread_deg = 5\n");
  const auto scenario = read_scenario(path);
  ASSERT_FALSE(scenario);
  const std::string error = scenario.error().to_line();
  EXPECT_TRUE(contains(error, "bend.toml:3: world.route_m: leg 1 passes 2.")) << error;
  EXPECT_TRUE(contains(error, "m from a wall at (20, 0); expected at least 4.66 m")) << error;
}

// The controller swings wide where it may hardly turn: no bound of what is drawn says so.
TEST(Route, DriveThatSwingsIntoAWallIsAnErrorAndNoLog) {
  Scenario scenario;
  scenario.drive.yaw_rate_max_radps = 0.05;
  scenario.drive.turn_in_place_deg = 90;
  const auto simulated = simulate(scenario, 1);
  ASSERT_FALSE(simulated);
  EXPECT_TRUE(contains(simulated.error().to_line(), "paper-corridor-s1: after "));
  EXPECT_TRUE(contains(simulated.error().to_line(), "from a wall at ("))
      << simulated.error().to_line();
}

TEST(Route, DriveThatDoesNotReachItsEndIsAnErrorAndNoLog) {
  Scenario scenario;
  scenario.drive.speed_min_mps = scenario.drive.speed_max_mps = 3;
  scenario.drive.acceleration_mps2 = 10;
  scenario.drive.yaw_rate_max_radps = 0.01;  // 157 s for the corner
  scenario.drive.turn_in_place_deg = 5;
  scenario.drive.heading_spread_deg = scenario.drive.lateral_spread_m = 0;
  scenario.drive.start_spread_m = 0;
  const auto simulated = simulate(scenario, 1);
  ASSERT_FALSE(simulated);
  EXPECT_TRUE(contains(simulated.error().to_line(), "waypoint 2 of 2 is not reached within"))
      << simulated.error().to_line();
}

TEST(Route, DriveThatIsOverBeforeTheFirstScanIsAnErrorAndNoLog) {
  Scenario scenario;
  scenario.drive.stays = true;
  scenario.drive.stand_s = 0.05;
  EXPECT_TRUE(contains(simulate(scenario, 1).error().to_line(), "no scan in a drive of 0.05 s"));
}

std::string first_problem(const std::string& text) {
  const ScratchFolder folder;
  const auto scenario = read_scenario(folder.write("x.toml", text));
  return scenario ? "no error" : scenario.error().to_line();
}

TEST(ScenarioRoute, UnfitOnesAreRefusedWithTheirLine) {
  const std::string room =
      "[world]\npolygons = [{ points_m = [[0, 0], [9, 0], [9, 9], [0, 9]] }]\n";
  const std::string stays = "[drive]\nstays = true\nstand_s = 2\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {room + "route_m = [[1e308, nan]]\n" + stays, "x.toml:3: world.route_m: point 1 is ("},
      {room + "route_m = [[0, 4]]\n" + stays, "x.toml:3: world.route_m: leg 1 passes 0.00 m"},
      {room + "route_m = [[1e300, 4]]\n" + stays, "x.toml:3: world.route_m: point 1 is ("},
      {room + "route_m = [[4, 4], [4, 4]]\n", "x.toml:3: world.route_m: points 1 and 2 are both"},
      {room + "route_m = [[3, 4], [6, 4]]\n[draw]\nlength_spread = 0.1\n",
       "x.toml:5: draw.length_spread: expected 0"},
      {room + "route_m = [[3, 4], [6, 4]]\n[draw]\nalpha_spread_deg = 5\n",
       "x.toml:5: draw.alpha_spread_deg: expected 0"},
      {room + "route_m = [[3, 4], [6, 4]]\n[people]\nnum_people = 1\nlateral_spread_m = 10\n",
       "x.toml:6: people.lateral_spread_m = 10: expected no wall"},
      {"[people]\nnum_people = 2\nlateral_spread_m = 10\n",
       "x.toml:3: people.lateral_spread_m = 10: expected no wall"},
  };
  for (const auto& [text, expected] : cases) {
    EXPECT_TRUE(contains(first_problem(text), expected)) << first_problem(text);
  }
}

}  // namespace
}  // namespace corridor::simulation::testing
