#include "baselines/dead_reckoning/dead_reckoning.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace corridor::dead_reckoning {
namespace {

LaserScan scan_at(double stamp_s) {
  LaserScan scan;
  scan.stamp = timestamp_from_seconds(stamp_s);
  scan.range_max_m = 5;
  scan.ranges_m = {1};
  scan.is_valid = {1};
  return scan;
}

// A circle of radius 1 m at 1 m/s from anywhere in the odometry's frame; the wheels see the turn
// `wheel_turn_ratio` times too large, the gyro with a bias and only until gyro_end_s. It stands
// still for the first second.
SlamEstimate drive_circle(const DeadReckoningParams& params, double wheel_turn_ratio, double bias,
                          double gyro_end_s = 100) {
  const auto system = make_dead_reckoning(params, RobotModel{});
  const Pose2 origin(7, -3, 2);
  Pose2 odometry = origin;
  constexpr double kDt_s = 0.01;
  const int num_steps = 100 + static_cast<int>(std::lround(2 * std::numbers::pi / kDt_s));
  for (int i = 0; i <= num_steps; ++i) {
    const double t = i * kDt_s;
    const bool is_moving = i > 100;
    if (is_moving) {
      odometry = odometry * Pose2::exp({kDt_s, 0, wheel_turn_ratio * kDt_s});
    }
    const Timestamp stamp = timestamp_from_seconds(t);
    EXPECT_TRUE(system->step(WheelSample{stamp, odometry, std::nullopt}).has_value());
    if (t < gyro_end_s) {
      const double rate_radps = bias + (is_moving ? 1.0 : 0.0);
      EXPECT_TRUE(system->step(ImuSample{stamp, rate_radps, 0, 0}).has_value());
    }
    if (i % 10 == 0) {
      EXPECT_TRUE(system->step(scan_at(t)).has_value());
    }
  }
  return *system->finish();
}

// Arcs of 0.1 s are driven as chords turned by half the correction: 1e-4 m each, second order.
constexpr double kArcTolerance_m = 0.01;

TEST(DeadReckoning, GivenGoodWheelsFollowsTheCircle) {
  const SlamEstimate estimate = drive_circle({}, 1, 0);
  ASSERT_GT(estimate.trajectory.size(), 70u);
  EXPECT_LT(estimate.trajectory.front().T_map_base.log().norm(), 1e-12);
  // The last scan comes after 6.2 s of driving.
  const Pose2 truth = Pose2::exp({6.2, 0, 6.2});
  EXPECT_LT(estimate.trajectory.back().T_map_base.minus(truth).norm(), 1e-9);
  EXPECT_FALSE(estimate.map.has_value());
}

TEST(DeadReckoning, WheelsThatTurnTooMuchLeaveIt) {
  EXPECT_GT(drive_circle({}, 1.2, 0).trajectory.back().T_map_base.translation_m().norm(), 0.3);
}

TEST(DeadReckoningGyro, TakesTheHeadingFromTheGyroAndItsBiasFromTheStandstill) {
  DeadReckoningParams params;
  params.use_gyro = true;
  const SlamEstimate estimate = drive_circle(params, 1.2, 0.05);
  const Pose2 reference = drive_circle({}, 1, 0).trajectory.back().T_map_base;
  const Pose2 last = estimate.trajectory.back().T_map_base;
  EXPECT_LT((last.translation_m() - reference.translation_m()).norm(), 2 * kArcTolerance_m);
  EXPECT_LT(std::abs(wrap_angle(last.theta_rad() - reference.theta_rad())), 0.02);
  EXPECT_GE(estimate.counters.at("gyro_bias_samples"), 100);
}

TEST(DeadReckoningGyro, LeavesTheTurnToTheWheelsWhereTheGyroIsSilent) {
  const SlamEstimate estimate = drive_circle({.use_gyro = true}, 1, 0, 3);
  const Pose2 truth = Pose2::exp({6.2, 0, 6.2});
  const Pose2 error = estimate.trajectory.back().T_map_base.between(truth);
  // The last reading stands for three intervals of 10 ms more, of a step that is the wheels' then.
  EXPECT_LT(error.translation_m().norm(), kArcTolerance_m);
  EXPECT_NEAR(error.theta_rad(), 0, 1e-6);
}

TEST(DeadReckoningGyro, SaysThatALogHasNoGyro) {
  DeadReckoningParams params;
  params.use_gyro = true;
  const auto system = make_dead_reckoning(params, RobotModel{});
  const auto report = system->step(scan_at(0));
  ASSERT_FALSE(report.has_value());
  EXPECT_NE(report.error().to_line().find("no IMU"), std::string::npos);
}

TEST(DeadReckoning, KeepsTheLastPoseWhereTheWheelsAreSilent) {
  const auto system = make_dead_reckoning({}, RobotModel{});
  ASSERT_TRUE(system->step(WheelSample{{}, {}, std::nullopt}).has_value());
  ASSERT_TRUE(system->step(scan_at(0)).has_value());
  const auto late = system->step(scan_at(5));
  ASSERT_TRUE(late.has_value());
  EXPECT_EQ(*late->T_map_base, Pose2());
}

TEST(DeadReckoning, NoEventsGiveAnEmptyTrajectory) {
  EXPECT_TRUE(make_dead_reckoning({}, RobotModel{})->finish()->trajectory.empty());
}

}  // namespace
}  // namespace corridor::dead_reckoning
