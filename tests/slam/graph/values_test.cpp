#include "slam/graph/values.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "slam/core/rng.hpp"

namespace corridor::graph {
namespace {

TEST(Values, KeysComeInOrderOfKindThenIndex) {
  Values values;
  values.set_wheel_scale(0, 0.1);
  values.set_bias(1, Eigen::Vector3d::Zero());
  values.set_pose(2, {});
  values.set_pose(0, {});
  const std::vector<Key> expected = {pose_key(0), pose_key(2), bias_key(1), wheel_scale_key(0)};
  EXPECT_EQ(values.keys(), expected);
  EXPECT_EQ(values.size(), 4u);
}

TEST(Values, AGapBetweenIndicesIsNotAVariable) {
  Values values;
  values.set_pose(5, {});
  EXPECT_FALSE(values.contains(pose_key(4)));
  EXPECT_FALSE(values.contains(velocity_key(5)));
  EXPECT_TRUE(values.contains(pose_key(5)));
}

TEST(Values, TakesIndicesInAnyOrder) {
  Values values;
  for (const std::uint32_t index : {7u, 3u, 9u, 3u}) values.set_pose(index, {1.0 * index, 0, 0});
  EXPECT_EQ(values.size(), 3u);
  for (const std::uint32_t index : {3u, 7u, 9u}) EXPECT_EQ(values.pose(index).x_m(), index);
  for (const std::uint32_t index : {0u, 4u, 8u, 10u})
    EXPECT_FALSE(values.contains(pose_key(index)));
}

TEST(Values, SettingAgainReplaces) {
  Values values;
  values.set_velocity(0, {1, 2});
  values.set_velocity(0, {3, 4});
  EXPECT_EQ(values.velocity(0), Eigen::Vector2d(3, 4));
  EXPECT_EQ(values.size(), 1u);
}

TEST(Values, RetractMovesAPoseInItsOwnFrame) {
  Values values;
  values.set_pose(0, {1, 1, 1.5707963267948966});
  const Eigen::Vector3d delta(1, 0, 0);
  values.retract(pose_key(0), delta.data());
  EXPECT_NEAR(values.pose(0).x_m(), 1, 1e-12);
  EXPECT_NEAR(values.pose(0).y_m(), 2, 1e-12);
}

RC_GTEST_PROP(Values, AnOrientedPoseTurnsAsItsPose, (std::uint64_t seed)) {
  Rng rng(seed);
  const OrientedPose pose(Pose2(rng.normal(), rng.normal(), rng.uniform(-3, 3)));
  const Eigen::Vector2d v(rng.normal(), rng.normal());
  const Pose2::Tangent tau(rng.normal(), rng.normal(), rng.normal());
  RC_ASSERT((pose.turn(v) - pose.pose.rotation() * v).norm() < 1e-14 * (1 + v.norm()));
  RC_ASSERT((pose.turn_back(pose.turn(v)) - v).norm() < 1e-14 * (1 + v.norm()));
  RC_ASSERT(pose.plus(tau).pose.minus(pose.pose.plus(tau)).norm() < 1e-13 * (1 + tau.norm()));
}

TEST(Values, RetractAddsToVectors) {
  Values values;
  values.set_bias(0, {1, 2, 3});
  values.set_wheel_scale(0, 0.5);
  const Eigen::Vector3d ones(1, 1, 1);
  values.retract(bias_key(0), ones.data());
  const double quarter = 0.25;
  values.retract(wheel_scale_key(0), &quarter);
  EXPECT_EQ(values.bias(0), Eigen::Vector3d(2, 3, 4));
  EXPECT_EQ(values.wheel_scale(0), 0.75);
}

TEST(Values, MergeTakesTheOthersValues) {
  Values base, other;
  base.set_pose(0, {1, 0, 0});
  base.set_pose(1, {2, 0, 0});
  other.set_pose(1, {3, 0, 0});
  other.set_velocity(1, {1, 1});
  base.merge(other);
  EXPECT_EQ(base.pose(0).x_m(), 1);
  EXPECT_EQ(base.pose(1).x_m(), 3);
  EXPECT_EQ(base.size(), 3u);
}

}  // namespace
}  // namespace corridor::graph
