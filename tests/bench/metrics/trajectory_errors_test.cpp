#include "bench/metrics/trajectory_errors.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/bench/metrics/test_trajectories.hpp"

namespace corridor::metrics {
namespace {

constexpr double kSecond = 1e-9;  // agreement of two implementations
constexpr double kExact = 1e-12;
constexpr double kDegPerRad = 180 / std::numbers::pi;

// Second implementation, on homogeneous matrices and by SVD, without Pose2's algebra.
Eigen::Matrix3d as_matrix(const Pose2& pose) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(pose.theta_rad()).toRotationMatrix();
  matrix(0, 2) = pose.x_m();
  matrix(1, 2) = pose.y_m();
  return matrix;
}

Eigen::Matrix3d alignment_matrix(const std::vector<MatchedPose>& pairs, Alignment alignment) {
  if (alignment == Alignment::kNone) return Eigen::Matrix3d::Identity();
  if (alignment == Alignment::kOrigin) {
    return as_matrix(pairs[0].T_world_base) * as_matrix(pairs[0].T_map_base).inverse();
  }
  Eigen::Matrix2Xd map(2, pairs.size()), world(2, pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    map.col(static_cast<Eigen::Index>(i)) = pairs[i].T_map_base.translation_m();
    world.col(static_cast<Eigen::Index>(i)) = pairs[i].T_world_base.translation_m();
  }
  return Eigen::umeyama(map, world, false);
}

std::vector<std::pair<double, double>> ape_by_matrices(const std::vector<MatchedPose>& pairs,
                                                       Alignment alignment) {
  const Eigen::Matrix3d A = alignment_matrix(pairs, alignment);
  std::vector<std::pair<double, double>> errors;
  for (const MatchedPose& pair : pairs) {
    const Eigen::Matrix3d E =
        as_matrix(pair.T_world_base).inverse() * A * as_matrix(pair.T_map_base);
    errors.emplace_back(std::hypot(E(0, 2), E(1, 2)),
                        std::abs(std::atan2(E(1, 0), E(0, 0))) * kDegPerRad);
  }
  return errors;
}

std::pair<double, double> rpe_by_matrices(const MatchedPose& i, const MatchedPose& j) {
  const Eigen::Matrix3d true_motion =
      as_matrix(i.T_world_base).inverse() * as_matrix(j.T_world_base);
  const Eigen::Matrix3d motion = as_matrix(i.T_map_base).inverse() * as_matrix(j.T_map_base);
  const Eigen::Matrix3d E = true_motion.inverse() * motion;
  return {std::hypot(E(0, 2), E(1, 2)), std::abs(std::atan2(E(1, 0), E(0, 0))) * kDegPerRad};
}

void expect_near(const PoseErrors& errors, const std::vector<std::pair<double, double>>& expected) {
  ASSERT_EQ(errors.translation_m.size(), expected.size());
  ASSERT_EQ(errors.rotation_deg.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(errors.translation_m[i], expected[i].first, kSecond);
    EXPECT_NEAR(errors.rotation_deg[i], expected[i].second, kSecond * kDegPerRad);
  }
}

Association random_case(std::uint64_t seed) {
  Rng rng(seed);
  const Trajectory truth = random_walk(rng, 80);
  const Pose2 T_map_world(rng.uniform(-9, 9), rng.uniform(-9, 9), rng.uniform(-3, 3));
  return associated(disturbed(truth, T_map_world, 0.3, 0.1, rng), truth);
}

TEST(AbsolutePoseErrors, AgreeWithASecondImplementation) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Association association = random_case(seed);
    for (const auto alignment : {Alignment::kOrigin, Alignment::kSe2, Alignment::kNone}) {
      expect_near(absolute_pose_errors(association, alignment),
                  ape_by_matrices(association.pairs, alignment));
    }
  }
}

TEST(RelativePoseErrors, AgreeWithASecondImplementation) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Association association = random_case(seed);
    std::vector<std::pair<double, double>> consecutive, all, over_path;
    for (std::size_t i = 0; i + 7 < association.pairs.size(); ++i) {
      const auto error = rpe_by_matrices(association.pairs[i], association.pairs[i + 7]);
      all.push_back(error);
      if (i % 7 == 0) consecutive.push_back(error);
    }
    expect_near(relative_pose_errors(association, 7, PairSelection::kAll), all);
    expect_near(relative_pose_errors(association, 7, PairSelection::kConsecutive), consecutive);
    for (std::size_t i = 0; i < association.pairs.size(); ++i) {
      double path_m = 0;
      for (std::size_t j = i + 1; j < association.pairs.size(); ++j) {
        path_m += (association.pairs[j].T_world_base.translation_m() -
                   association.pairs[j - 1].T_world_base.translation_m())
                      .norm();
        if (path_m < 1) continue;
        if (path_m <= 1.5) {
          over_path.push_back(rpe_by_matrices(association.pairs[i], association.pairs[j]));
        }
        break;
      }
    }
    expect_near(relative_pose_errors_over_path(association, 1), over_path);
  }
}

TEST(TrajectoryScores, AreHandComputed) {
  // Straight along x, 1 m a step. The estimate takes 1.1 m steps and, at the end, looks 10 deg to
  // the left.
  const double turned = 10 / kDegPerRad;
  const auto truth = trajectory_of(
      {{0, Pose2(0, 0, 0)}, {1, Pose2(1, 0, 0)}, {2, Pose2(2, 0, 0)}, {3, Pose2(3, 0, 0)}});
  const auto estimate = trajectory_of({{0, Pose2(5, 5, 0)},
                                       {1, Pose2(6.1, 5, 0)},
                                       {2, Pose2(7.2, 5, 0)},
                                       {3, Pose2(8.3, 5, turned)}});
  const auto scores = score_trajectory(associated(estimate, truth));
  // Errors 0, 0.1, 0.2, 0.3 m: sqrt(0.14 / 4).
  EXPECT_NEAR(*scores.position_rmse_m, std::sqrt(0.035), kExact);
  EXPECT_NEAR(*scores.angle_rmse_deg, 5, kExact * kDegPerRad);  // sqrt(10^2 / 4)
  // Centred: -0.15, -0.05, 0.05, 0.15 m: sqrt(0.05 / 4).
  EXPECT_NEAR(*scores.ate_se2_rmse_m, std::sqrt(0.0125), kExact);
  EXPECT_NEAR(*scores.ate_se2_angle_rmse_deg, 5, kExact * kDegPerRad);
  EXPECT_NEAR(*scores.rpe_1m_rmse_m, 0.1, kExact);
  EXPECT_NEAR(*scores.rpe_1m_angle_rmse_deg, std::sqrt(100.0 / 3), kExact * kDegPerRad);
}

RC_GTEST_PROP(TrajectoryScores, DoNotDependOnTheFrameOfTheMap, ()) {
  Rng rng(*rc::gen::arbitrary<std::uint64_t>());
  const Trajectory truth = random_walk(rng, 40);
  const Trajectory estimate = disturbed(truth, Pose2(), 0.1, 0.05, rng);
  Rng silent(0);
  const Pose2 shift(rng.uniform(-9, 9), rng.uniform(-9, 9), rng.uniform(-3, 3));
  const auto here = score_trajectory(associated(estimate, truth));
  const auto there = score_trajectory(associated(disturbed(estimate, shift, 0, 0, silent), truth));
  RC_ASSERT(std::abs(*here.position_rmse_m - *there.position_rmse_m) < 1e-9);
  RC_ASSERT(std::abs(*here.ate_se2_rmse_m - *there.ate_se2_rmse_m) < 1e-9);
  RC_ASSERT(std::abs(*here.rpe_1m_rmse_m - *there.rpe_1m_rmse_m) < 1e-9);
  RC_ASSERT(*here.ate_se2_rmse_m <= *here.position_rmse_m + 1e-12);
}

TEST(TrajectoryScores, OfThePerfectEstimateAreZero) {
  Rng rng(1);
  const Trajectory truth = random_walk(rng, 50);
  const auto scores = score_trajectory(associated(truth, truth));
  for (const auto& score : {scores.position_rmse_m, scores.angle_rmse_deg, scores.ate_se2_rmse_m,
                            scores.rpe_1m_rmse_m, scores.rpe_1m_angle_rmse_deg}) {
    EXPECT_NEAR(*score, 0, 1e-10);
  }
}

TEST(TrajectoryScores, AreMissingForFewerThanTwoPairs) {
  const auto one = trajectory_of({{0, Pose2(1, 2, 3)}});
  for (const auto& association : {associated({}, {}), associated(one, one)}) {
    const auto scores = score_trajectory(association);
    EXPECT_FALSE(scores.position_rmse_m);
    EXPECT_FALSE(scores.angle_rmse_deg);
    EXPECT_FALSE(scores.ate_se2_rmse_m);
    EXPECT_FALSE(scores.rpe_1m_rmse_m);
  }
}

TEST(TrajectoryScores, OfARobotThatStoodStillLackOnlyWhatIsUndefined) {
  const auto truth = trajectory_of({{0, Pose2()}, {1, Pose2()}, {2, Pose2()}});
  const auto estimate = trajectory_of({{0, Pose2()}, {1, Pose2(0.3, 0, 0)}, {2, Pose2(0, 0.4, 0)}});
  const auto scores = score_trajectory(associated(estimate, truth));
  EXPECT_NEAR(*scores.position_rmse_m, std::sqrt(0.25 / 3), kExact);
  EXPECT_FALSE(scores.ate_se2_rmse_m);  // no rotation is best
  EXPECT_FALSE(scores.rpe_1m_rmse_m);   // no path
}

TEST(RelativePoseErrors, OverPathLeaveOutGapsInTheTruth) {
  const auto truth = trajectory_of(
      {{0, Pose2(0, 0, 0)}, {1, Pose2(0.6, 0, 0)}, {2, Pose2(1.2, 0, 0)}, {3, Pose2(9, 0, 0)}});
  EXPECT_EQ(relative_pose_errors_over_path(associated(truth, truth), 1).translation_m.size(), 1U);
}

TEST(RelativePoseErrors, NeedAStep) {
  const Association association = random_case(1);
  EXPECT_TRUE(relative_pose_errors(association, 0, PairSelection::kAll).translation_m.empty());
  EXPECT_TRUE(relative_pose_errors_over_path(association, 0).translation_m.empty());
  EXPECT_TRUE(relative_pose_errors_over_path(association, std::nan("")).translation_m.empty());
}

TEST(Summarise, IsHandComputed) {
  const std::vector<double> errors{1, 2, 3, 6};
  const auto statistics = summarise(errors);
  ASSERT_TRUE(statistics);
  EXPECT_NEAR(statistics->sse, 50, kExact);
  EXPECT_NEAR(statistics->rmse, std::sqrt(12.5), kExact);
  EXPECT_NEAR(statistics->mean, 3, kExact);
  EXPECT_NEAR(statistics->median, 2.5, kExact);
  EXPECT_NEAR(statistics->std, std::sqrt(3.5), kExact);
  EXPECT_EQ(statistics->min, 1);
  EXPECT_EQ(statistics->max, 6);
  EXPECT_EQ(statistics->num_errors, 4U);
  EXPECT_FALSE(summarise({}));
}

TEST(Align, Se2RecoversTheFrameExactly) {
  Rng rng(4);
  const Trajectory truth = random_walk(rng, 30);
  const Pose2 T_map_world(3, -2, 2.5);
  Rng silent(0);
  const auto association = associated(disturbed(truth, T_map_world, 0, 0, silent), truth);
  const auto T_world_map = align(association.pairs, Alignment::kSe2);
  ASSERT_TRUE(T_world_map);
  EXPECT_LT((*T_world_map * T_map_world).log().norm(), 1e-12);
}

TEST(Align, Se2IsTheBestOfAllNearbyMotions) {
  const Association association = random_case(8);
  const Pose2 best = *align(association.pairs, Alignment::kSe2);
  const auto cost = [&](const Pose2& T_world_map) {
    double sum = 0;
    for (const auto& pair : association.pairs) {
      sum += (T_world_map * pair.T_map_base.translation_m() - pair.T_world_base.translation_m())
                 .squaredNorm();
    }
    return sum;
  };
  Rng rng(2);
  for (int i = 0; i < 100; ++i) {
    const Pose2 other = best.plus({rng.normal(0, 0.01), rng.normal(0, 0.01), rng.normal(0, 0.01)});
    EXPECT_GT(cost(other), cost(best));
  }
}

TEST(Align, TextSurvives) {
  for (const auto alignment : {Alignment::kOrigin, Alignment::kSe2, Alignment::kNone}) {
    EXPECT_EQ(alignment_from_text(to_text(alignment)), alignment);
  }
  EXPECT_FALSE(alignment_from_text("sim3"));
  EXPECT_FALSE(align({}, Alignment::kNone));
}

}  // namespace
}  // namespace corridor::metrics
