#include "bench/metrics/association.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/bench/metrics/test_trajectories.hpp"

namespace corridor::metrics {
namespace {

constexpr double kExact = 1e-12;

Trajectory at_seconds(const std::vector<double>& stamps_s) {
  std::vector<std::pair<double, Pose2>> poses;
  for (const double stamp_s : stamps_s) poses.emplace_back(stamp_s, Pose2(stamp_s, 0, 0));
  return trajectory_of(poses);
}

std::vector<std::pair<double, double>> matched_seconds(const Association& association) {
  std::vector<std::pair<double, double>> result;
  for (const MatchedPose& pair : association.pairs) {
    result.emplace_back(pair.T_map_base.x_m(), pair.T_world_base.x_m());
  }
  return result;
}

using Pairs = std::vector<std::pair<double, double>>;

TEST(AssociateNearest, EachPoseIsUsedAtMostOnce) {
  const auto association =
      associate(at_seconds({1.00, 1.02, 1.04}), at_seconds({1.03}), AssociationRule::kNearest, 0.1);
  EXPECT_EQ(matched_seconds(association), (Pairs{{1.02, 1.03}}));
  EXPECT_EQ(association.num_estimate_matched, 1U);
  EXPECT_EQ(association.num_estimate_unmatched, 2U);
  EXPECT_EQ(association.num_truth_matched, 1U);
  EXPECT_EQ(association.num_truth_unmatched, 0U);
}

TEST(AssociateNearest, ClosestPairsComeFirst) {
  // 2.1 is nearest to 2.0 and 2.12; the latter pair is closer, and 2.0 then goes without.
  const auto association = associate(at_seconds({2.1, 3.0}), at_seconds({2.0, 2.12, 3.05}),
                                     AssociationRule::kNearest, 0.15);
  EXPECT_EQ(matched_seconds(association), (Pairs{{2.1, 2.12}, {3.0, 3.05}}));
}

TEST(AssociateNearest, TakesStampsOfTheTruthAndTheLimitItself) {
  const auto association =
      associate(at_seconds({1.0}), at_seconds({1.25}), AssociationRule::kNearest, 0.25);
  ASSERT_EQ(association.pairs.size(), 1U);
  EXPECT_EQ(association.pairs[0].stamp, timestamp_from_seconds(1.25));
  EXPECT_TRUE(associate(at_seconds({1.0}), at_seconds({1.26}), AssociationRule::kNearest, 0.25)
                  .pairs.empty());
}

// Second implementation: all pairs by distance, greedy, none that crosses a taken one.
Pairs associate_by_trying_all(const std::vector<double>& estimate, const std::vector<double>& truth,
                              double max_dt_s) {
  struct Candidate {
    double dt, e, t;
  };
  std::vector<Candidate> all;
  for (const double e : estimate) {
    for (const double t : truth) {
      if (std::abs(e - t) <= max_dt_s) all.push_back({std::abs(e - t), e, t});
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.dt < b.dt; });
  Pairs taken;
  for (const Candidate& candidate : all) {
    const bool is_free = std::all_of(taken.begin(), taken.end(), [&](const auto& pair) {
      return (candidate.e < pair.first && candidate.t < pair.second) ||
             (candidate.e > pair.first && candidate.t > pair.second);
    });
    if (is_free) taken.emplace_back(candidate.e, candidate.t);
  }
  std::sort(taken.begin(), taken.end());
  return taken;
}

RC_GTEST_PROP(AssociateNearest, EqualsTryingAllPairsWhileStampsAreFartherApartThanTheLimit, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  Rng rng(seed);
  // Stamps in whole milliseconds, so that distances are exact in both implementations.
  const auto random_stamps = [&] {
    std::vector<double> stamps_s;
    double stamp_ms = static_cast<double>(rng.below(60));
    const auto n = rng.below(30);
    for (std::uint64_t i = 0; i < n; ++i) {
      stamps_s.push_back(stamp_ms / 1000);
      stamp_ms += static_cast<double>(51 + rng.below(60));
    }
    return stamps_s;
  };
  const auto estimate = random_stamps();
  const auto truth = random_stamps();
  const auto association =
      associate(at_seconds(estimate), at_seconds(truth), AssociationRule::kNearest, 0.0255);
  RC_ASSERT(matched_seconds(association) == associate_by_trying_all(estimate, truth, 0.0255));
  RC_ASSERT(association.num_truth_matched + association.num_truth_unmatched == truth.size());
  RC_ASSERT(association.num_estimate_matched + association.num_estimate_unmatched ==
            estimate.size());
}

TEST(Associate, StampsInMillisecondsShowAsUnmatched) {
  std::vector<double> seconds, milliseconds;
  for (int i = 0; i < 100; ++i) {
    seconds.push_back(0.1 * i);
    milliseconds.push_back(100.0 * i);
  }
  const auto association =
      associate(at_seconds(milliseconds), at_seconds(seconds), AssociationRule::kNearest);
  EXPECT_EQ(association.pairs.size(), 1U);  // the one at zero
  EXPECT_EQ(association.num_truth_unmatched, 99U);
}

TEST(Associate, ShuffledInputIsRefusedByTheTrajectory) {
  EXPECT_TRUE(at_seconds({1.0, 3.0, 2.0}).empty());
  EXPECT_TRUE(at_seconds({1.0, 1.0}).empty());
}

TEST(Associate, EmptyTrajectoriesMatchNothing) {
  for (const auto rule : {AssociationRule::kNearest, AssociationRule::kInterpolate}) {
    EXPECT_TRUE(associate({}, {}, rule).pairs.empty());
    EXPECT_EQ(associate(at_seconds({1}), {}, rule).num_estimate_unmatched, 1U);
    EXPECT_EQ(associate({}, at_seconds({1}), rule).num_truth_unmatched, 1U);
  }
}

TEST(Associate, NegativeOrUndefinedLimitMatchesNothing) {
  for (const auto rule : {AssociationRule::kNearest, AssociationRule::kInterpolate}) {
    for (const double max_dt_s : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
      EXPECT_TRUE(associate(at_seconds({1}), at_seconds({1}), rule, max_dt_s).pairs.empty());
    }
  }
}

TEST(AssociateInterpolate, TruthIsInterpolatedAtTheEstimatesStamps) {
  const auto truth = trajectory_of({{1.0, Pose2(0, 0, 0)}, {1.1, Pose2(1, 0, 0)}});
  const auto association =
      associate(at_seconds({0.99, 1.025, 1.2}), truth, AssociationRule::kInterpolate, 0.1);
  ASSERT_EQ(association.pairs.size(), 1U);
  EXPECT_EQ(association.pairs[0].stamp, timestamp_from_seconds(1.025));
  EXPECT_NEAR(association.pairs[0].T_world_base.x_m(), 0.25, kExact);
  EXPECT_EQ(association.num_estimate_unmatched, 2U);
  EXPECT_EQ(association.num_truth_matched, 2U);
}

TEST(AssociateInterpolate, DoesNotBridgeGapsInTheTruth) {
  const auto truth = at_seconds({1.0, 5.0});
  EXPECT_TRUE(
      associate(at_seconds({1.005}), truth, AssociationRule::kInterpolate, 0.1).pairs.empty());
  // A true pose at the very stamp needs no neighbour.
  EXPECT_EQ(
      associate(at_seconds({1.0, 5.0}), truth, AssociationRule::kInterpolate, 0.1).pairs.size(),
      2U);
}

TEST(NearestPose, TakesTheNearerAndOfTwoTheEarlier) {
  const auto trajectory = at_seconds({1.0, 2.0});
  const auto nearest = [&](double stamp_s, double max_dt_s) {
    return nearest_pose(trajectory, timestamp_from_seconds(stamp_s), max_dt_s);
  };
  EXPECT_EQ(nearest(1.4, 1), 0U);
  EXPECT_EQ(nearest(1.6, 1), 1U);
  EXPECT_EQ(nearest(1.5, 1), 0U);
  EXPECT_EQ(nearest(0.0, 1), 0U);
  EXPECT_EQ(nearest(3.0, 1), 1U);
  EXPECT_FALSE(nearest(3.1, 1));
  EXPECT_FALSE(nearest_pose({}, {}, 1));
}

TEST(AssociationRule, SurvivesItsText) {
  for (const auto rule : {AssociationRule::kNearest, AssociationRule::kInterpolate}) {
    EXPECT_EQ(association_rule_from_text(to_text(rule)), rule);
  }
  EXPECT_FALSE(association_rule_from_text("closest"));
}

}  // namespace
}  // namespace corridor::metrics
