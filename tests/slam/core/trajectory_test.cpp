#include "slam/core/trajectory.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "slam/core/rng.hpp"

namespace corridor {
namespace {

constexpr double kExact = 1e-12;

TrajectoryPose pose_at(double time_s, const Pose2& T_map_base) {
  return {timestamp_from_seconds(time_s), T_map_base, std::nullopt};
}

Trajectory trajectory_of(std::initializer_list<TrajectoryPose> poses) {
  Trajectory trajectory;
  for (const TrajectoryPose& pose : poses) EXPECT_TRUE(trajectory.append(pose));
  return trajectory;
}

TEST(Trajectory, RefusesStampsThatDoNotIncrease) {
  Trajectory trajectory = trajectory_of({pose_at(1, {})});
  EXPECT_FALSE(trajectory.append(pose_at(1, {1, 0, 0})));
  EXPECT_FALSE(trajectory.append(pose_at(0.5, {})));
  EXPECT_EQ(trajectory.size(), 1u);
  EXPECT_EQ(trajectory.back().T_map_base, Pose2());
}

TEST(Trajectory, RefusesPosesThatAreNotFinite) {
  Trajectory trajectory;
  EXPECT_FALSE(trajectory.append(pose_at(1, {NAN, 0, 0})));
  EXPECT_FALSE(trajectory.append(pose_at(1, {0, INFINITY, 0})));
  EXPECT_FALSE(trajectory.append(pose_at(1, {0, 0, NAN})));
  EXPECT_TRUE(trajectory.empty());
}

TEST(Trajectory, InterpolatesNothingOutsideItsEnds) {
  EXPECT_FALSE(Trajectory().interpolate({0}));
  const Trajectory trajectory = trajectory_of({pose_at(1, {}), pose_at(2, {1, 0, 0})});
  EXPECT_FALSE(trajectory.interpolate(timestamp_from_seconds(0.999999999)));
  EXPECT_FALSE(trajectory.interpolate(timestamp_from_seconds(2.000000001)));
}

TEST(Trajectory, InterpolationMeetsItsPosesExactly) {
  const Trajectory trajectory =
      trajectory_of({pose_at(1, {1, 2, 3}), pose_at(2, {4, 5, -3}), pose_at(4, {7, 8, 0.1})});
  for (const TrajectoryPose& pose : trajectory.poses()) {
    EXPECT_EQ(*trajectory.interpolate(pose.stamp), pose.T_map_base);
  }
}

TEST(Trajectory, InterpolatesStraightMotionLinearly) {
  const Trajectory trajectory = trajectory_of({pose_at(0, {}), pose_at(4, {2, 0, 0})});
  EXPECT_NEAR(trajectory.interpolate(timestamp_from_seconds(1))->x_m(), 0.5, kExact);
}

TEST(Trajectory, InterpolatesATurnAlongItsArc) {
  // A quarter circle of radius 1: after half of the time half of the angle.
  const double pi = std::numbers::pi;
  const Trajectory trajectory = trajectory_of({pose_at(0, {}), pose_at(1, {1, 1, pi / 2})});
  const Pose2 middle = *trajectory.interpolate(timestamp_from_seconds(0.5));
  EXPECT_NEAR(middle.theta_rad(), pi / 4, kExact);
  EXPECT_NEAR(middle.x_m(), std::sin(pi / 4), kExact);
  EXPECT_NEAR(middle.y_m(), 1 - std::cos(pi / 4), kExact);
}

TEST(Trajectory, InterpolatesOverTheSeamOfTheAngleTheShortWay) {
  const Trajectory trajectory = trajectory_of({pose_at(0, {0, 0, 3}), pose_at(1, {0, 0, -3})});
  const double middle_rad = trajectory.interpolate(timestamp_from_seconds(0.5))->theta_rad();
  EXPECT_NEAR(std::abs(middle_rad), std::numbers::pi, 1e-9);
}

RC_GTEST_PROP(Trajectory, InterpolationDoesNotDependOnTheMapFrame, (std::uint64_t seed)) {
  Rng rng(seed);
  const auto random_pose = [&] {
    return Pose2(rng.uniform(-5, 5), rng.uniform(-5, 5), rng.uniform(-3, 3));
  };
  const Pose2 T_other_map = random_pose();
  const Pose2 first = random_pose();
  const Pose2 second = first * Pose2::exp({rng.uniform(), rng.uniform(), rng.uniform(-1, 1)});
  const Trajectory in_map = trajectory_of({pose_at(0, first), pose_at(1, second)});
  const Trajectory in_other =
      trajectory_of({pose_at(0, T_other_map * first), pose_at(1, T_other_map * second)});
  const Timestamp stamp = timestamp_from_seconds(rng.uniform());
  const Pose2 expected = T_other_map * *in_map.interpolate(stamp);
  RC_ASSERT(in_other.interpolate(stamp)->minus(expected).norm() < 1e-10);
}

TEST(Trajectory, PathLengthIsTheSumOfItsSteps) {
  EXPECT_EQ(Trajectory().path_length_m(), 0);
  EXPECT_EQ(trajectory_of({pose_at(0, {5, 5, 0})}).path_length_m(), 0);
  EXPECT_NEAR(trajectory_of({pose_at(0, {}), pose_at(1, {3, 4, 1}), pose_at(2, {3, 4, 2}),
                             pose_at(3, {0, 0, 0})})
                  .path_length_m(),
              10, kExact);
}

}  // namespace
}  // namespace corridor
