#include "datasets/simulation/people.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "datasets/simulation/lidar_model.hpp"
#include "datasets/simulation/simulate.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

using Eigen::Vector2d;

const std::vector<Vector2d> kRoute_m{{0, 0}, {20, 0}};
const Vector2d kFarAway_m{0, 1000};

TEST(People, NeverComeNearerToTheRobotThanArmsLength) {
  const PeopleParams params{.num_people = 30, .lateral_spread_m = 0.5};
  const People people(params, kRoute_m, Rng(1));
  double nearest_m = 1e9;
  for (int k = 0; k < 4000; ++k) {
    const double time_s = 0.05 * k;
    const Vector2d robot_m(std::fmod(0.5 * time_s, 20), 0.1);
    for (const Person& person : people.at(time_s, robot_m)) {
      nearest_m = std::min(nearest_m, (person.centre_m - robot_m).norm() - person.radius_m);
    }
  }
  EXPECT_GE(nearest_m, 0.7 - 1e-12);
  EXPECT_LT(nearest_m, 0.7 + 1e-9);  // some had to step aside
}

TEST(People, WhoWouldStandOnTheRobotsVeryCentreStepAsideToo) {
  const PeopleParams params{.num_people = 1, .speed_min_mps = 0, .speed_max_mps = 0};
  const People people(params, kRoute_m, Rng(1));
  const Vector2d centre_m = people.at(0, kFarAway_m)[0].centre_m;
  EXPECT_NEAR((people.at(0, centre_m)[0].centre_m - centre_m).norm(), 0.7 + 0.22, 1e-12);
}

TEST(People, WalkUpAndDownTheRouteAtTheirOwnSpeedBesideIt) {
  const PeopleParams params{.num_people = 200};
  const People people(params, kRoute_m, Rng(2));
  const auto now = people.at(100, kFarAway_m);
  const auto then = people.at(100.1, kFarAway_m);
  double least_mps = 1e9, most_mps = 0, farthest_m = 0;
  int num_up = 0, num_down = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    EXPECT_GE(now[i].centre_m.x(), 0);
    EXPECT_LE(now[i].centre_m.x(), 20);
    EXPECT_EQ(now[i].centre_m.y(), then[i].centre_m.y());
    farthest_m = std::max(farthest_m, std::abs(now[i].centre_m.y()));
    const double step_m = then[i].centre_m.x() - now[i].centre_m.x();
    const bool has_turned = std::min(now[i].centre_m.x(), 20 - now[i].centre_m.x()) < 0.15;
    if (has_turned) continue;
    least_mps = std::min(least_mps, std::abs(step_m) / 0.1);
    most_mps = std::max(most_mps, std::abs(step_m) / 0.1);
    ++(step_m > 0 ? num_up : num_down);
  }
  EXPECT_GE(least_mps, 0.7 - 1e-9);
  EXPECT_LE(most_mps, 1.4 + 1e-9);
  EXPECT_LE(farthest_m, 1.0);
  EXPECT_GT(farthest_m, 0.9);
  EXPECT_NEAR(num_up - num_down, 0, 5 * std::sqrt(200));
}

TEST(People, FollowARouteAroundItsCorners) {
  const PeopleParams params{.num_people = 50, .lateral_spread_m = 0};
  const People people(params, {{0, 0}, {10, 0}, {10, 10}}, Rng(3));
  for (int k = 0; k < 200; ++k) {
    for (const Person& person : people.at(0.3 * k, kFarAway_m)) {
      const double off_m =
          std::min(std::abs(person.centre_m.y()), std::abs(person.centre_m.x() - 10));
      EXPECT_NEAR(off_m, 0, 1e-9);
    }
  }
}

TEST(People, AreDiscsToALidarAndHideTheWallBehindThem) {
  const World world = world_of({{{5, -9}, {5, 9}}});
  const LidarParams params{.num_beams = 181, .field_of_view_deg = 90, .range_max_m = 20};
  const std::vector<Person> people{{{3, 0}, 0.25}};
  const Sweep sweep = LidarModel(world, params).sweep([](double) { return Pose2(); }, people);
  for (int i = 0; i < params.num_beams; ++i) {
    const double angle_rad = beam_angle_rad(params, i);
    const double beside_m = 3 * std::sin(angle_rad);  // the beam's distance from the centre
    const auto& hit = *sweep.hits[static_cast<std::size_t>(i)];
    EXPECT_EQ(hit.is_person, std::abs(beside_m) < 0.25);
    EXPECT_NEAR(hit.range_m,
                hit.is_person ? 3 * std::cos(angle_rad) - std::sqrt(0.0625 - beside_m * beside_m)
                              : 5 / std::cos(angle_rad),
                1e-9);
  }
}

TEST(People, ChangeScansOnly) {
  const Simulated alone = simulated_log(shipped_scenario("paper-corridor"), 2);
  const Simulated crowded = simulated_log(shipped_scenario("paper-corridor-people"), 2);
  ASSERT_EQ(alone.log.events.size(), crowded.log.events.size());
  int num_changed = 0;
  for (std::size_t i = 0; i < alone.log.events.size(); ++i) {
    const SensorEvent& one = alone.log.events[i];
    const SensorEvent& other = crowded.log.events[i];
    if (const auto* imu = std::get_if<ImuSample>(&one)) {
      EXPECT_EQ(imu->accel_y_mps2, std::get<ImuSample>(other).accel_y_mps2);
    } else if (const auto* wheels = std::get_if<WheelSample>(&one)) {
      EXPECT_EQ(wheels->T_odom_base, std::get<WheelSample>(other).T_odom_base);
    } else {
      num_changed += std::get<LaserScan>(one).ranges_m != std::get<LaserScan>(other).ranges_m;
    }
  }
  EXPECT_GT(num_changed, 50);
}

}  // namespace
}  // namespace corridor::simulation::testing
