#include "slam/graph/values.hpp"

#include <gtest/gtest.h>

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
  values.retract(pose_key(0), Eigen::Vector3d(1, 0, 0));
  EXPECT_NEAR(values.pose(0).x_m(), 1, 1e-12);
  EXPECT_NEAR(values.pose(0).y_m(), 2, 1e-12);
}

TEST(Values, RetractAddsToVectors) {
  Values values;
  values.set_bias(0, {1, 2, 3});
  values.set_wheel_scale(0, 0.5);
  values.retract(bias_key(0), Eigen::Vector3d(1, 1, 1));
  values.retract(wheel_scale_key(0), Eigen::VectorXd::Constant(1, 0.25));
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
