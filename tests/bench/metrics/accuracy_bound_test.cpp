#include "bench/metrics/accuracy_bound.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "datasets/simulation/simulate.hpp"

namespace corridor::metrics {
namespace {

constexpr double kHalfRoom_m = 2;
constexpr double kSigma_m = 0.01;

simulation::World room() {
  const double r = kHalfRoom_m;
  simulation::World world;
  world.walls = {{{-r, -r}, {r, -r}}, {{r, -r}, {r, r}}, {{r, r}, {-r, r}}, {{-r, r}, {-r, -r}}};
  return world;
}

LaserScan four_beams(double stamp_s, std::size_t num_beams) {
  LaserScan scan;
  scan.stamp = timestamp_from_seconds(stamp_s);
  scan.angle_increment_rad = std::numbers::pi / 2;
  scan.range_max_m = 10;
  scan.ranges_m.assign(num_beams, static_cast<float>(kHalfRoom_m));
  scan.is_valid.assign(num_beams, 1);
  return scan;
}

// A robot that stands in the middle of a square room, scans it twice, and has wheels that tell
// next to nothing but that it did not turn.
SensorLog standing(std::size_t num_beams) {
  SensorLog log;
  log.robot.lidar.range_sigma_m = kSigma_m;
  log.robot.wheels.left_m_per_tick = log.robot.wheels.right_m_per_tick = 1;
  log.truth.emplace();
  for (const double stamp_s : {0.0, 1.0}) {
    log.events.emplace_back(WheelSample{timestamp_from_seconds(stamp_s), Pose2(), {}});
    log.events.emplace_back(four_beams(stamp_s, num_beams));
    EXPECT_TRUE(log.truth->append({timestamp_from_seconds(stamp_s), Pose2(), {}}));
  }
  return log;
}

simulation::Simulated corridor(std::uint64_t seed) {
  simulation::Scenario scenario;
  scenario.lidar.range_max_m = 4.5;
  return *simulation::simulate(scenario, seed);
}

// Two beams see each axis, once to find the walls and once to find the robot between them: a
// variance of sigma^2 / 2 each time and on each axis, none in the first pose.
TEST(AccuracyBound, OfTwoScansOfAnUnknownRoomIsHandComputed) {
  const auto bound = accuracy_bound(standing(4), room(), {});
  ASSERT_TRUE(bound.has_value());
  EXPECT_NEAR(bound->position_rmse_m, kSigma_m, 0.002 * kSigma_m);
}

// One beam sees x: a variance of 2 sigma^2. None sees y, to the robot's side: that it did not slide
// there is known to a tick, 1 m.
TEST(AccuracyBound, AlongWhatNoBeamSeesIsThatOfTheWheels) {
  const auto bound = accuracy_bound(standing(1), room(), {});
  ASSERT_TRUE(bound.has_value());
  const double expected_m = std::sqrt((2 * kSigma_m * kSigma_m + 1) / 2);
  EXPECT_NEAR(bound->position_rmse_m, expected_m, 0.01 * expected_m);
}

TEST(AccuracyBound, DoesNotExistWhereNothingTellsTheMotion) {
  SensorLog log = standing(1);
  std::erase_if(log.events, [](const SensorEvent& event) {
    return std::holds_alternative<WheelSample>(event);
  });
  EXPECT_FALSE(accuracy_bound(log, room(), {}).has_value());
  log = standing(4);
  log.truth.reset();
  EXPECT_FALSE(accuracy_bound(log, room(), {}).has_value());
}

TEST(AccuracyBound, RisesWithTheRangeNoiseAndWithEverySensorThatIsMissing) {
  const simulation::Simulated simulated = corridor(3);
  const auto all = accuracy_bound(simulated.log, simulated.world, {});
  ASSERT_TRUE(all.has_value());
  EXPECT_GT(all->position_rmse_m, 0.001);
  EXPECT_LT(all->position_rmse_m, 0.02);
  EXPECT_LT(all->angle_rmse_deg, 0.05);

  SensorLog noisy = simulated.log;
  noisy.robot.lidar.range_sigma_m *= 2;
  EXPECT_GT(accuracy_bound(noisy, simulated.world, {})->position_rmse_m, all->position_rmse_m);
  EXPECT_GT(accuracy_bound(noisy, simulated.world, {})->angle_rmse_deg, all->angle_rmse_deg);

  SensorLog without_imu = simulated.log;
  std::erase_if(without_imu.events,
                [](const SensorEvent& event) { return std::holds_alternative<ImuSample>(event); });
  SensorLog without_wheels = simulated.log;
  std::erase_if(without_wheels.events, [](const SensorEvent& event) {
    return std::holds_alternative<WheelSample>(event);
  });
  for (const SensorLog* less : {&without_imu, &without_wheels}) {
    const auto bound = accuracy_bound(*less, simulated.world, {});
    ASSERT_TRUE(bound.has_value());
    EXPECT_GT(bound->position_rmse_m, all->position_rmse_m);
    EXPECT_GE(bound->angle_rmse_deg, all->angle_rmse_deg);
  }
}

TEST(AccuracyBound, CountsNoWheelsThatSlip) {
  const simulation::Simulated simulated = corridor(3);
  const double end_s = to_seconds(stamp_of(simulated.log.events.back())) + 1;
  const std::vector<simulation::SlipInterval> always = {{0, end_s, 0.5, {}}};
  SensorLog without_wheels = simulated.log;
  std::erase_if(without_wheels.events, [](const SensorEvent& event) {
    return std::holds_alternative<WheelSample>(event);
  });
  EXPECT_EQ(accuracy_bound(simulated.log, simulated.world, always)->position_rmse_m,
            accuracy_bound(without_wheels, simulated.world, {})->position_rmse_m);
}

}  // namespace
}  // namespace corridor::metrics
