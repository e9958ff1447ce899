#include "bench/metrics/relations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "tests/bench/metrics/test_trajectories.hpp"

namespace corridor::metrics {
namespace {

constexpr double kSecond = 1e-9;
constexpr double kExact = 1e-12;

Timestamp at(double seconds) { return timestamp_from_seconds(seconds); }

TEST(Relations, ErrorsAreHandComputed) {
  const double degree = std::numbers::pi / 180;
  const auto estimate =
      trajectory_of({{0, Pose2(0, 0, 90 * degree)}, {1, Pose2(0, 2, 90 * degree)}});
  // 2 m straight ahead as estimated. One relation says 1.7 m and 4 deg, the other 2 m and 0.4 m
  // aside.
  const std::vector<formats::Relation> relations{{at(0), at(1), Pose2(1.7, 0, 4 * degree)},
                                                 {at(0), at(1), Pose2(2, 0.4, 0)}};
  const auto scores = score_relations(estimate, relations, 0.1);
  EXPECT_EQ(scores.relations_used, 2);
  EXPECT_EQ(scores.relations_skipped, 0);
  EXPECT_NEAR(*scores.relations_translation_mean_m, 0.35, kExact);
  EXPECT_NEAR(*scores.relations_translation_std_m, 0.05, kExact);
  EXPECT_NEAR(*scores.relations_rotation_mean_deg, 2, 1e-10);
  EXPECT_NEAR(*scores.relations_rotation_std_deg, 2, 1e-10);
}

TEST(Relations, BackwardInTimeCountLikeOthers) {
  const auto estimate = trajectory_of({{0, Pose2(0, 0, 0)}, {1, Pose2(1, 0, 0)}});
  const std::vector<formats::Relation> relations{{at(1), at(0), Pose2(-1, 0, 0)}};
  EXPECT_NEAR(*score_relations(estimate, relations).relations_translation_mean_m, 0, kExact);
}

TEST(Relations, WithoutPosesAreSkippedAndCounted) {
  const auto estimate = trajectory_of({{0, Pose2()}, {1, Pose2(1, 0, 0)}});
  const std::vector<formats::Relation> relations{{at(0), at(1), Pose2(1, 0, 0)},
                                                 {at(0), at(1.2), Pose2(1, 0, 0)},
                                                 {at(-7), at(1), Pose2(1, 0, 0)}};
  const auto scores = score_relations(estimate, relations, 0.1);
  EXPECT_EQ(scores.relations_used, 1);
  EXPECT_EQ(scores.relations_skipped, 2);
}

TEST(Relations, NoneAndNoneUsableAreTold) {
  EXPECT_FALSE(score_relations({}, {}).relations_used);
  const std::vector<formats::Relation> relations{{at(0), at(1), Pose2()}};
  const auto scores = score_relations({}, relations);
  EXPECT_EQ(scores.relations_used, 0);
  EXPECT_EQ(scores.relations_skipped, 1);
  EXPECT_FALSE(scores.relations_translation_mean_m);
}

// Second implementation: poses as complex numbers, nearest stamps by looking at all.
TEST(Relations, AgreeWithASecondImplementation) {
  using Complex = std::complex<double>;
  Rng rng(6);
  const Trajectory estimate = random_walk(rng, 200);
  std::vector<formats::Relation> relations;
  for (int i = 0; i < 100; ++i) {
    relations.push_back({at(rng.uniform(0, 20)), at(rng.uniform(0, 20)),
                         Pose2(rng.normal(), rng.normal(), rng.uniform(-3, 3))});
  }
  const PoseErrors errors = relation_errors(estimate, relations, 0.03);
  std::size_t num_used = 0;
  const auto nearest = [&](Timestamp stamp) {
    const TrajectoryPose* best = nullptr;
    for (const auto& pose : estimate.poses()) {
      const double dt_s = std::abs(seconds_between(pose.stamp, stamp));
      if (dt_s > 0.03) continue;
      if (best == nullptr || dt_s < std::abs(seconds_between(best->stamp, stamp))) best = &pose;
    }
    return best;
  };
  for (const auto& relation : relations) {
    const auto* one = nearest(relation.t1);
    const auto* two = nearest(relation.t2);
    if (one == nullptr || two == nullptr) continue;
    const auto position = [](const Pose2& p) { return Complex(p.x_m(), p.y_m()); };
    const auto turn = [](const Pose2& p) { return std::polar(1.0, p.theta_rad()); };
    const Complex motion =
        (position(two->T_map_base) - position(one->T_map_base)) * std::conj(turn(one->T_map_base));
    const Complex turned =
        turn(two->T_map_base) * std::conj(turn(one->T_map_base)) * std::conj(turn(relation.T_1_2));
    ASSERT_LT(num_used, errors.translation_m.size());
    EXPECT_NEAR(errors.translation_m[num_used], std::abs(motion - position(relation.T_1_2)),
                kSecond);
    EXPECT_NEAR(errors.rotation_deg[num_used], std::abs(std::arg(turned)) * 180 / std::numbers::pi,
                kSecond);
    ++num_used;
  }
  EXPECT_EQ(num_used, errors.translation_m.size());
  EXPECT_GT(num_used, 20U);
  EXPECT_LT(num_used, 100U);
}

}  // namespace
}  // namespace corridor::metrics
