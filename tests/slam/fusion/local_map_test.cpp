#include "slam/fusion/local_map.hpp"

#include <gtest/gtest.h>

#include "slam/fusion/loop_closer.hpp"
#include "tests/support/synthetic_scan.hpp"

namespace corridor::fusion {
namespace {

// Key scans on a line, 0.5 m apart, all at their true poses.
struct Drive {
  explicit Drive(const FusionParams& p) : params(p), map(params) {}

  void add(const Pose2& pose, double path_m) {
    const auto key = static_cast<std::uint32_t>(key_scans.size());
    KeyScan scan;
    scan.scan = testing::scan_of(testing::room(), pose, 30, 0.01, rng);
    scan.points_base_m = testing::points_of(scan.scan);
    scan.path_m = path_m;
    values.set_pose(key, pose);
    key_scans.push_back(scan);
    map.insert(key, values, key_scans.back().points_base_m);
  }

  FusionParams params;
  LocalMap map;
  graph::Values values;
  std::vector<KeyScan> key_scans;
  Rng rng{8};
};

TEST(LocalMap, TwoSubmapsOverlapByHalf) {
  FusionParams params;
  params.submap_key_scans = 10;
  Drive run(params);
  for (int i = 0; i < 25; ++i) run.add({0.1 * i - 1, 0, 0}, 0.1 * i);
  // Origins at 0, 5, 10, 15, 20; those from 0, 5, 10, 15 are full after 10, 15, 20, 25 key scans.
  EXPECT_EQ(run.map.num_submaps(), 5u);
  ASSERT_EQ(run.map.finished().size(), 4u);
  EXPECT_EQ(run.map.finished()[1]->origin_key(), 5u);
  EXPECT_EQ(run.map.finished()[1]->num_scans(), 10);
  EXPECT_EQ(run.map.active().origin_key(), 20u);
}

TEST(LocalMap, WithoutSubmapsMatchesAgainstTheLastKeyScan) {
  FusionParams params = fusion_paper_params();
  Drive run(params);
  for (int i = 0; i < 5; ++i) {
    run.add({0.1 * i, 0, 0}, 0.1 * i);
    EXPECT_EQ(run.map.active().origin_key(), static_cast<std::uint32_t>(i));
    EXPECT_EQ(run.map.active().num_scans(), 1);
  }
}

TEST(LoopCloser, ClosesWhenTwoSearchesAgreeAndPutsTheDriftIntoTheClosure) {
  FusionParams params;
  params.submap_key_scans = 4;
  params.loop_min_path_m = 2;
  Drive run(params);
  for (int i = 0; i < 8; ++i) run.add({0.25 * i - 1, 0, 0}, 0.25 * i);
  LoopCloser closer(run.params);
  // Far along its path the robot is back at the start, but believes to be 0.25 m off.
  std::vector<LoopClosure> found;
  for (int i = 0; i < 2; ++i) {
    const Pose2 truth(-1 + 0.1 * i, 0, 0);
    const auto key = static_cast<std::uint32_t>(run.key_scans.size());
    run.add(truth, 20 + i);
    run.values.set_pose(key, Pose2(truth.x_m() + 0.25, truth.y_m() - 0.1, 0.03));
    found = closer.search(run.key_scans, run.map, run.values, 0.01);
    if (i == 0) {
      EXPECT_TRUE(found.empty());
    }
  }
  ASSERT_EQ(found.size(), 2u);
  for (const LoopClosure& closure : found) {
    const Pose2 closed = run.values.pose(closure.submap_key) * closure.match.T_map_base;
    const double truth_x = -1 + 0.1 * (closure.scan_key - 8);
    EXPECT_NEAR(closed.x_m(), truth_x, 0.02);
    EXPECT_NEAR(closed.y_m(), 0, 0.02);
    EXPECT_NEAR(closed.theta_rad(), 0, 0.01);
  }
}

TEST(LoopCloser, FindsNothingInAnotherRoom) {
  FusionParams params;
  params.submap_key_scans = 4;
  params.loop_min_path_m = 2;
  Drive run(params);
  for (int i = 0; i < 8; ++i) run.add({0.25 * i - 1, 0, 0}, 0.25 * i);
  LoopCloser closer(run.params);
  Rng rng(9);
  for (int i = 0; i < 3; ++i) {
    run.add({-1 + 0.1 * i, 0, 0}, 20 + i);
    auto& points = run.key_scans.back().points_base_m;
    points = testing::points_of(testing::scan_of(testing::corridor_walls(), {}, 8, 0.01, rng));
    EXPECT_TRUE(closer.search(run.key_scans, run.map, run.values, 0.01).empty());
  }
  EXPECT_GT(closer.num_candidates(), 0);
}

}  // namespace
}  // namespace corridor::fusion
