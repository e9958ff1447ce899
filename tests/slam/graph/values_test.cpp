#include "slam/graph/values.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <vector>

#include "slam/core/rng.hpp"

namespace corridor::graph {
namespace {

motion::WheelCalibration calibration(double value) {
  return motion::WheelCalibration::Constant(value);
}

TEST(Values, KeysComeInOrderOfKindThenIndex) {
  Values values;
  values.set_wheel_calibration(0, calibration(0.1));
  values.set_bias(1, motion::ImuBias::Zero());
  values.set_pose(2, {});
  values.set_pose(0, {});
  const std::vector<Key> expected = {pose_key(0), pose_key(2), bias_key(1),
                                     wheel_calibration_key(0)};
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

RC_GTEST_PROP(Values, AreTheSameInWhateverOrderTheyAreSet, (std::uint64_t seed)) {
  Rng rng(seed);
  std::map<std::uint32_t, double> expected;
  Values values;
  for (int k = 0; k < 30; ++k) {
    const auto index = static_cast<std::uint32_t>(500 + rng.below(60) - rng.below(500));
    expected[index] = rng.normal();
    values.set_wheel_calibration(index, calibration(expected[index]));
  }
  RC_ASSERT(values.size() == expected.size());
  std::vector<Key> keys;
  for (const auto& [index, value] : expected) {
    keys.push_back(wheel_calibration_key(index));
    RC_ASSERT(values.wheel_calibration(index) == calibration(value));
  }
  RC_ASSERT(values.keys() == keys);
  Values merged;
  merged.set_wheel_calibration(0, calibration(0));
  merged.merge(values);
  for (const auto& [index, value] : expected)
    RC_ASSERT(merged.wheel_calibration(index) == calibration(value));
}

TEST(Values, RetractOfManyIsThatOfEachWithItsPart) {
  Values values;
  values.set_pose(3, {1, 2, 0.5});
  values.set_velocity(1, {1, 1});
  values.set_pose(7, {4, 5, -0.5});
  Values one_by_one = values;
  const std::vector<Key> keys = {pose_key(7), velocity_key(1), pose_key(3)};
  const std::vector<double> deltas = {1, 2, 3, 4, 5, 6, 7, 8};
  values.retract(keys, deltas.data());
  one_by_one.retract(keys[0], &deltas[0]);
  one_by_one.retract(keys[1], &deltas[3]);
  one_by_one.retract(keys[2], &deltas[5]);
  EXPECT_EQ(values.pose(3), one_by_one.pose(3));
  EXPECT_EQ(values.pose(7), one_by_one.pose(7));
  EXPECT_EQ(values.velocity(1), one_by_one.velocity(1));
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
  values.set_bias(0, {1, 2, 3, 4});
  values.set_wheel_calibration(0, calibration(0.5));
  const motion::ImuBias ones = motion::ImuBias::Ones();
  values.retract(bias_key(0), ones.data());
  const motion::WheelCalibration quarter = calibration(0.25);
  values.retract(wheel_calibration_key(0), quarter.data());
  EXPECT_EQ(values.bias(0), motion::ImuBias(2, 3, 4, 5));
  EXPECT_EQ(values.wheel_calibration(0), calibration(0.75));
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
