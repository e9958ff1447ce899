#include "datasets/simulation/robot_drive.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

constexpr double kStep_s = 0.005;
// Limits are met to rounding.
constexpr double kTight = 1e-9;

Drive drive_of_seed(std::uint64_t seed, const DriveParams& params = {},
                    const CorridorShape& shape = {}) {
  return drive_along(draw_plan(make_corridor(shape), params, Rng(seed)), params, kStep_s);
}

RC_GTEST_PROP(Drive, NeverBreaksTheLimitsOfTheRobot, (std::uint64_t seed)) {
  const DriveParams params;
  const Drive drive = drive_of_seed(seed);
  for (std::size_t k = 1; k < drive.states.size(); ++k) {
    const DriveState& from = drive.states[k - 1];
    const DriveState& to = drive.states[k];
    RC_ASSERT(to.speed_mps >= 0 && to.speed_mps <= params.speed_max_mps + kTight);
    RC_ASSERT(std::abs(to.yaw_rate_radps) <= params.yaw_rate_max_radps + kTight);
    RC_ASSERT(std::abs(to.speed_mps - from.speed_mps) <=
              params.acceleration_mps2 * kStep_s + kTight);
    RC_ASSERT(std::abs(to.yaw_rate_radps - from.yaw_rate_radps) <=
              params.yaw_acceleration_radps2 * kStep_s + kTight);
  }
}

RC_GTEST_PROP(Drive, EachStepIsTheArcOfItsMeanSpeedAndYawRate, (std::uint64_t seed)) {
  const Drive drive = drive_of_seed(seed);
  for (std::size_t k = 1; k < drive.states.size(); k += 37) {
    const DriveState& from = drive.states[k - 1];
    const DriveState& to = drive.states[k];
    const Pose2::Tangent step = to.T_world_base.minus(from.T_world_base);
    RC_ASSERT(std::abs(step.x() - 0.5 * (from.speed_mps + to.speed_mps) * kStep_s) < kTight);
    RC_ASSERT(std::abs(step.y()) < kTight);  // wheels do not slide sideways
    RC_ASSERT(std::abs(step.z() - 0.5 * (from.yaw_rate_radps + to.yaw_rate_radps) * kStep_s) <
              kTight);
  }
}

RC_GTEST_PROP(Drive, KeepsHalfAMetreFromEveryWall, (std::uint64_t seed)) {
  const World world = make_corridor({});
  const Drive drive = drive_of_seed(seed);
  for (std::size_t k = 0; k < drive.states.size(); k += 10) {
    RC_ASSERT(clearance_m(world, drive.states[k].T_world_base.translation_m()) > 0.5);
  }
}

RC_GTEST_PROP(Drive, StartsAndEndsWhereThePaperDoes, (std::uint64_t seed)) {
  const Drive drive = drive_of_seed(seed);
  RC_ASSERT(drive.is_complete);
  const Pose2 start = drive.states.front().T_world_base;
  const Pose2 end = drive.states.back().T_world_base;
  RC_ASSERT(std::abs(start.x_m() - 2.5) <= 0.3 && std::abs(start.y_m() - 2.5) <= 0.3);
  RC_ASSERT(std::abs(start.theta_rad()) <= 20 * std::numbers::pi / 180);
  // Lateral spread 0.4 m, reached within 0.2 m.
  RC_ASSERT(std::abs(end.x_m() - 18.5) <= 0.6 && std::abs(end.y_m() - 12) <= 0.2 + kTight);
}

RC_GTEST_PROP(Drive, ReturnTripEndsAtItsStart, (std::uint64_t seed)) {
  DriveParams params;
  params.is_return_trip = true;
  const Drive drive = drive_of_seed(seed, params);
  RC_ASSERT(drive.is_complete);
  const Eigen::Vector2d apart_m = drive.states.back().T_world_base.translation_m() -
                                  drive.states.front().T_world_base.translation_m();
  RC_ASSERT(apart_m.norm() <= params.waypoint_reach_m);
}

RC_GTEST_PROP(Drive, StaysInsideCorridorsOfAnyAngle, (std::uint64_t seed)) {
  Rng rng(seed);
  const CorridorShape shape{.a_m = rng.uniform(16, 25),
                            .b_m = rng.uniform(16, 25),
                            .c_m = rng.uniform(4, 5),
                            .alpha_rad = rng.uniform(60, 120) * std::numbers::pi / 180};
  DriveParams params;
  params.num_arm_waypoints = 2;
  const World world = make_corridor(shape);
  const Drive drive = drive_of_seed(seed, params, shape);
  RC_ASSERT(drive.is_complete);
  for (std::size_t k = 0; k < drive.states.size(); k += 20) {
    RC_ASSERT(clearance_m(world, drive.states[k].T_world_base.translation_m()) > 0.5);
  }
}

TEST(Drive, SeedsDifferInStartHeadingSpeedAndPath) {
  for (std::uint64_t seed = 1; seed < 10; ++seed) {
    const DrivePlan one = draw_plan(make_corridor({}), {}, Rng(seed));
    const DrivePlan other = draw_plan(make_corridor({}), {}, Rng(seed + 1));
    EXPECT_NE(one.T_world_base_start.x_m(), other.T_world_base_start.x_m());
    EXPECT_NE(one.T_world_base_start.y_m(), other.T_world_base_start.y_m());
    EXPECT_NE(one.T_world_base_start.theta_rad(), other.T_world_base_start.theta_rad());
    EXPECT_NE(one.speed_mps, other.speed_mps);
    EXPECT_NE(one.waypoints_m.front().y(), other.waypoints_m.front().y());
    EXPECT_NE(one.waypoints_m.back().x(), other.waypoints_m.back().x());
  }
}

TEST(Drive, DrawsSpeedsUniformlyBetweenItsBounds) {
  std::vector<double> speeds_mps;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    speeds_mps.push_back(draw_plan(make_corridor({}), {}, Rng(seed)).speed_mps);
  }
  const auto [least, most] = std::minmax_element(speeds_mps.begin(), speeds_mps.end());
  EXPECT_GE(*least, 0.4);
  EXPECT_LT(*most, 0.6);
  // Five standard errors of the mean, (0.2 / sqrt(12)) / sqrt(2000).
  EXPECT_NEAR(mean(speeds_mps), 0.5, 5 * 0.0013);
}

TEST(Drive, SaysWhenAWaypointWasNotReachedInTheTimeAllowed) {
  DriveParams params;
  params.yaw_rate_max_radps = 0.001;  // the turn at the corner would take 26 minutes
  EXPECT_FALSE(drive_of_seed(1, params).is_complete);
}

TEST(Drive, StandsThenTurnsAsOftenAsStatedOnTheSpot) {
  for (const double turns : {-1.25, 0.1, 3.0}) {
    const DriveParams params{.stand_s = 2, .spin_turns = turns, .stays = true};
    const Drive drive = drive_of_seed(1, params);
    EXPECT_TRUE(drive.is_complete);
    double turned_rad = 0;
    for (std::size_t k = 1; k < drive.states.size(); ++k) {
      EXPECT_EQ(drive.states[k].T_world_base.translation_m(),
                drive.states[0].T_world_base.translation_m());
      const double step_rad =
          drive.states[k].T_world_base.minus(drive.states[k - 1].T_world_base).z();
      if (k <= 400) {
        EXPECT_EQ(step_rad, 0);
      }
      turned_rad += step_rad;
    }
    // It comes to rest within a step at full rate.
    EXPECT_NEAR(turned_rad, 2 * std::numbers::pi * turns, params.yaw_rate_max_radps * kStep_s);
    EXPECT_EQ(drive.states.back().yaw_rate_radps, 0);
  }
}

RC_GTEST_PROP(Drive, FollowsADrawnRouteToItsEnd, (std::uint64_t seed)) {
  World world = world_of({{{-50, -50}, {50, -50}}});
  world.route_m = {{0, 0}, {8, 0}, {8, 6}, {2, 9}};
  const DriveParams params{.lateral_spread_m = 0.3};
  const Drive drive = drive_along(draw_plan(world, params, Rng(seed)), params, kStep_s);
  RC_ASSERT(drive.is_complete);
  const Eigen::Vector2d end_m = drive.states.back().T_world_base.translation_m();
  RC_ASSERT((end_m - Eigen::Vector2d(2, 9)).norm() <= 0.3 + params.waypoint_reach_m + kTight);
}

}  // namespace
}  // namespace corridor::simulation::testing
