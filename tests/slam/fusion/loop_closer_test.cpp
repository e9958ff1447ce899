#include "slam/fusion/loop_closer.hpp"

#include <gtest/gtest.h>

#include "tests/slam/fusion/drive.hpp"

namespace corridor::fusion {
namespace {

// Eight key scans through a room make finished submaps; far along its path the robot is back at the
// start, and believes to be somewhere else.
class LoopCloserTest : public ::testing::Test {
 protected:
  LoopCloserTest() {
    drive_.params.submap_key_scans = 4;
    drive_.params.loop_min_path_m = 2;
    for (int i = 0; i < 8; ++i) drive_.add({0.25 * i - 1, 0, 0}, 0.25 * i);
  }

  // The i-th key scan after the return, i metres of path after the first, believed to be at `drift`
  // from the truth.
  std::vector<LoopClosure> come_back(int i, const Pose2& drift) {
    const Pose2 truth = back(i);
    const auto key = static_cast<std::uint32_t>(drive_.key_scans.size());
    drive_.add(truth, 20 + i);
    drive_.values.set_pose(key, Pose2(truth.x_m() + drift.x_m(), truth.y_m() + drift.y_m(),
                                      truth.theta_rad() + drift.theta_rad()));
    return closer_.search(drive_.key_scans, drive_.map, drive_.values);
  }
  static Pose2 back(int i) { return {-1 + 0.1 * i, 0, 0}; }

  void expect_true(const LoopClosure& closure) const {
    const Pose2 closed = drive_.values.pose(closure.submap_frame) * closure.match.T_map_base;
    const Pose2 truth = back(static_cast<int>(closure.scan_key) - 8);
    EXPECT_NEAR(closed.x_m(), truth.x_m(), 0.02);
    EXPECT_NEAR(closed.y_m(), truth.y_m(), 0.02);
    EXPECT_NEAR(closed.theta_rad(), truth.theta_rad(), 0.01);
  }

  const RobotModel robot_;
  Drive drive_{FusionParams{}};
  LoopCloser closer_{robot_, drive_.params};
  const Pose2 drift_{0.25, -0.1, 0.03};
};

TEST_F(LoopCloserTest, ClosesWhenThreeSearchesAgreeAndPutsTheDriftIntoTheClosures) {
  EXPECT_TRUE(come_back(0, drift_).empty());
  EXPECT_TRUE(come_back(1, drift_).empty());
  const std::vector<LoopClosure> found = come_back(2, drift_);
  ASSERT_EQ(found.size(), 3u);
  for (const LoopClosure& closure : found) expect_true(closure);
}

TEST_F(LoopCloserTest, OneThatOdometryContradictsIsNotAmongThoseThatAgree) {
  EXPECT_TRUE(come_back(0, drift_).empty());
  // Odometry says that the robot went half a metre aside and back again.
  EXPECT_TRUE(come_back(1, {drift_.x_m(), drift_.y_m() + 0.5, drift_.theta_rad()}).empty());
  EXPECT_TRUE(come_back(2, drift_).empty());
  const std::vector<LoopClosure> found = come_back(3, drift_);
  ASSERT_EQ(found.size(), 3u);
  for (const LoopClosure& closure : found) EXPECT_NE(closure.scan_key, 9u);
}

TEST_F(LoopCloserTest, ManyInOnePlaceCloseNothing) {
  drive_.params.loop_interval_m = 0.01;
  drive_.params.loop_min_span_m = 0.75;
  for (int i = 0; i < 9; ++i) {
    const auto key = static_cast<std::uint32_t>(drive_.key_scans.size());
    drive_.add(back(0), 20 + 0.1 * i);
    drive_.values.set_pose(key, {back(0).x_m() + drift_.x_m(), drift_.y_m(), drift_.theta_rad()});
    const auto found = closer_.search(drive_.key_scans, drive_.map, drive_.values);
    EXPECT_EQ(found.size(), i < 8 ? 0u : 9u) << i;
  }
}

TEST_F(LoopCloserTest, WhatWasRefutedIsGivenAgainOnceItIsFirm) {
  for (int i = 0; i < 3; ++i) EXPECT_EQ(come_back(i, drift_).empty(), i < 2);
  closer_.set_last_closure(0);  // none of it stayed
  EXPECT_TRUE(come_back(3, drift_).empty());
  EXPECT_TRUE(come_back(4, drift_).empty());
  const std::vector<LoopClosure> found = come_back(5, drift_);
  ASSERT_EQ(found.size(), 6u);
  EXPECT_TRUE(found.front().is_firm);
}

TEST_F(LoopCloserTest, ASetTwiceAsLargeAndThreeTimesAsLongIsFirm) {
  for (int i = 0; i < 6; ++i) {
    const std::vector<LoopClosure> found = come_back(i, drift_);
    if (i < 2) continue;
    ASSERT_EQ(found.size(), static_cast<std::size_t>(i + 1));
    for (const LoopClosure& closure : found) EXPECT_EQ(closure.is_firm, i == 5);
  }
}

TEST_F(LoopCloserTest, AfterAClosureEveryKeyScanIsMatchedDirectlyAtOnce) {
  closer_.set_last_closure(19);
  const std::vector<LoopClosure> found = come_back(0, {0.05, -0.03, 0.02});
  ASSERT_EQ(found.size(), 1u);
  expect_true(found.front());
}

TEST_F(LoopCloserTest, ADirectMatchThatLeavesItsNeighbourhoodDoesNotCount) {
  closer_.set_last_closure(19);
  drive_.params.loop_agreement_m = 0.03;
  EXPECT_TRUE(come_back(0, {0.1, -0.05, 0.02}).empty());
}

TEST_F(LoopCloserTest, FindsNothingInAnotherRoom) {
  Rng rng(9);
  for (int i = 0; i < 3; ++i) {
    drive_.add(back(i), 20 + i);
    auto& points = drive_.key_scans.back().points_base_m;
    points = testing::points_of(testing::scan_of(testing::corridor_walls(), {}, 8, 0.01, rng));
    EXPECT_TRUE(closer_.search(drive_.key_scans, drive_.map, drive_.values).empty());
  }
  EXPECT_GT(closer_.num_candidates(), 0);
}

}  // namespace
}  // namespace corridor::fusion
