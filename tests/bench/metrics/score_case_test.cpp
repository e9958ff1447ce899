#include "bench/metrics/score_case.hpp"

#include <gtest/gtest.h>

#include "tests/bench/metrics/test_corridor.hpp"
#include "tests/bench/metrics/test_trajectories.hpp"

namespace corridor::metrics {
namespace {

struct Case {
  simulation::World world = simulation::make_corridor({});
  Trajectory truth = drive({});
  std::vector<LaserScan> scans;
  std::vector<Timestamp> stamps;
  Trajectory final_trajectory, online;
  GridMap map;
  std::vector<formats::Relation> relations;

  Case() {
    Rng rng(1);
    scans = take_scans(world, truth, rng);
    for (const auto& scan : scans) stamps.push_back(scan.stamp);
    const Pose2 T_map_world = truth[0].T_map_base.inverse();
    final_trajectory = in_frame(truth, T_map_world);
    online = disturbed(truth, T_map_world, 0.1, 0.02, rng);
    map = map_at(scans, final_trajectory);
    relations = {{stamps[0], stamps[100], truth[0].T_map_base.between(truth[100].T_map_base)}};
  }

  [[nodiscard]] CaseEvidence evidence() const {
    return {&final_trajectory, &online, &map,        &map, stamps, &truth,
            relations,         &world,  kTestRange_m};
  }
};

TEST(ScoreCase, FillsEveryScoreOfACompleteCase) {
  const Case complete;
  results::RunResult result;
  const auto remarks = score_case(complete.evidence(), {}, result);
  EXPECT_TRUE(remarks.empty());
  EXPECT_EQ(result.poses_expected, static_cast<std::int64_t>(complete.stamps.size()));
  EXPECT_EQ(result.poses_matched, result.poses_expected);
  EXPECT_EQ(result.association, "nearest");
  EXPECT_EQ(result.alignment, "origin");
  EXPECT_NEAR(*result.final_scores.position_rmse_m, 0, 1e-9);
  EXPECT_GT(*result.online_scores.position_rmse_m, 0.05);
  EXPECT_NEAR(*result.final_relations.relations_translation_mean_m, 0, 1e-9);
  EXPECT_GT(*result.online_relations.relations_translation_mean_m, 0.01);
  EXPECT_EQ(result.own_map.key_distances->b.status, "ok");
  EXPECT_EQ(result.rendered_map.map_chamfer_m, result.own_map.map_chamfer_m);
  EXPECT_LT(*result.own_map.map_hausdorff95_m, 0.1);
}

TEST(ScoreCase, WithoutTruthScoresRelationsAndCountsScans) {
  const Case complete;
  auto evidence = complete.evidence();
  evidence.truth_world = nullptr;
  results::RunResult result;
  score_case(evidence, {}, result);
  EXPECT_EQ(result.poses_matched, static_cast<std::int64_t>(complete.stamps.size()));
  EXPECT_FALSE(result.final_scores.position_rmse_m);
  EXPECT_FALSE(result.association);
  EXPECT_FALSE(result.own_map.key_distances);
  EXPECT_EQ(result.final_relations.relations_used, 1);
}

TEST(ScoreCase, MissingPosesAreCounted) {
  const Case complete;
  Trajectory half;
  for (std::size_t i = 0; i < 30; ++i) ASSERT_TRUE(half.append(complete.final_trajectory[i]));
  auto evidence = complete.evidence();
  evidence.final_trajectory = &half;
  results::RunResult result;
  const auto remarks = score_case(evidence, {}, result);
  EXPECT_EQ(result.poses_matched, 30);
  EXPECT_EQ(result.poses_expected, static_cast<std::int64_t>(complete.stamps.size()));
  EXPECT_EQ(remarks.size(), 1U);
}

TEST(ScoreCase, StampsInMillisecondsAreRemarkedAndScoreNothing) {
  const Case complete;
  Trajectory milliseconds;
  for (const auto& pose : complete.final_trajectory.poses()) {
    ASSERT_TRUE(
        milliseconds.append({{pose.stamp.nanoseconds * 1000 + 7}, pose.T_map_base, std::nullopt}));
  }
  auto evidence = complete.evidence();
  evidence.final_trajectory = &milliseconds;
  results::RunResult result;
  const auto remarks = score_case(evidence, {}, result);
  EXPECT_EQ(result.poses_matched, 1);
  EXPECT_FALSE(result.final_scores.position_rmse_m);  // one pair has no error
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_NE(remarks[0].find("only 1 of"), std::string::npos) << remarks[0];
}

TEST(ScoreCase, NoPoseAtAllIsNoQuestionOfStamps) {
  const Case complete;
  const Trajectory nothing;
  auto evidence = complete.evidence();
  evidence.final_trajectory = nullptr;
  results::RunResult result;
  EXPECT_TRUE(score_case(evidence, {}, result).empty());
  EXPECT_EQ(result.poses_matched, 0);
  evidence.final_trajectory = &nothing;
  EXPECT_TRUE(score_case(evidence, {}, result).empty());
}

TEST(ScoreCase, ATruthOnAnotherClockIsRemarked) {
  const Case complete;
  Trajectory shifted;
  for (const auto& pose : complete.truth.poses()) {
    ASSERT_TRUE(shifted.append({add_seconds(pose.stamp, 1e6), pose.T_map_base, std::nullopt}));
  }
  auto evidence = complete.evidence();
  evidence.truth_world = &shifted;
  results::RunResult result;
  const auto remarks = score_case(evidence, {}, result);
  EXPECT_EQ(result.poses_expected, 0);
  EXPECT_EQ(remarks.size(), 1U);
}

TEST(ScoreCase, OfNothingLeavesEveryScoreNull) {
  results::RunResult result;
  result.poses_matched = 7;
  result.final_scores.position_rmse_m = 1;
  EXPECT_TRUE(score_case({}, {}, result).empty());
  EXPECT_FALSE(result.poses_expected || result.poses_matched);
  EXPECT_FALSE(result.final_scores.position_rmse_m || result.final_relations.relations_used);
  EXPECT_FALSE(result.own_map.map_chamfer_m || result.own_map.key_distances);
}

TEST(ScoreCase, TakesTheAlignmentAskedFor) {
  const Case complete;
  results::RunResult result;
  ScoringOptions options;
  options.alignment = Alignment::kSe2;
  score_case(complete.evidence(), options, result);
  EXPECT_EQ(result.alignment, "se2");
  EXPECT_EQ(result.online_scores.position_rmse_m, result.online_scores.ate_se2_rmse_m);
}

}  // namespace
}  // namespace corridor::metrics
