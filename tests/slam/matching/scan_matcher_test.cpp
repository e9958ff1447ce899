#include "slam/matching/scan_matcher.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>

#include "slam/matching/observability.hpp"
#include "tests/support/synthetic_scan.hpp"

namespace corridor::matching {
namespace {

constexpr double kRangeSigma_m = 0.015;

struct LocalMap {
  SurfelGrid fine{0.1}, coarse{0.4};

  void insert(const std::vector<Eigen::Vector2d>& points) {
    fine.insert(points);
    coarse.insert(points);
  }
  MatchResult match(const std::vector<Eigen::Vector2d>& points, const Pose2& prior,
                    const Eigen::Matrix3d& information = Eigen::Matrix3d::Zero()) {
    const std::array<SurfelGrid*, 2> levels = {&coarse, &fine};
    return match_scan(levels, points, prior, information, kRangeSigma_m, {});
  }
};

// Map of ten scans around the origin.
LocalMap map_of(const std::vector<testing::Wall>& walls, double range_m, Rng& rng) {
  LocalMap map;
  for (int i = 0; i < 10; ++i) {
    const Pose2 pose(0.1 * (i - 5), 0.02 * i, 0.03 * i);
    map.insert(testing::moved(
        pose, testing::points_of(testing::scan_of(walls, pose, range_m, kRangeSigma_m, rng))));
  }
  return map;
}

RC_GTEST_PROP(MatchScan, RecoversADisplacementInARoom, (std::uint64_t seed)) {
  Rng rng(seed);
  const auto walls = testing::room();
  LocalMap map = map_of(walls, 30, rng);
  const Pose2 truth(rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2), rng.uniform(-0.1, 0.1));
  const auto points = testing::points_of(testing::scan_of(walls, truth, 30, kRangeSigma_m, rng));
  const MatchResult result = map.match(points, {});
  RC_ASSERT(result.is_usable());
  // 360 ranges of 15 mm fix the pose to about 1.5 mm and 0.3 mrad; five of those and the map's
  // error.
  const Pose2::Tangent error = result.T_map_base.minus(truth);
  RC_ASSERT(error.head<2>().norm() < 0.012);
  RC_ASSERT(std::abs(error.z()) < 0.003);
  RC_ASSERT(observable_part(result, {}).num_observable == 3);
}

// The corridor's walls end where the range ends, and the robot moved 0.3 m along: nothing in the
// scan says so, and nothing may pull back to zero displacement.
RC_GTEST_PROP(MatchScan, IsNotDrawnBackAlongARangeLimitedCorridor, (std::uint64_t seed)) {
  Rng rng(seed);
  const auto walls = testing::corridor_walls();
  LocalMap map = map_of(walls, 4.5, rng);
  const Pose2 truth(1.0, 0.05, 0.02);
  const auto points = testing::points_of(testing::scan_of(walls, truth, 4.5, kRangeSigma_m, rng));
  // A weak prior: 5 cm and 0.05 rad.
  const Eigen::Matrix3d prior = Eigen::Vector3d(400, 400, 400).asDiagonal();
  const MatchResult result = map.match(points, truth, prior);
  RC_ASSERT(result.is_usable());
  const ObservableMatch part = observable_part(result, {});
  RC_ASSERT(part.num_observable == 2);
  // The corridor's axis and its normal, seen from the turned base.
  const Eigen::Vector2d axis = truth.rotation().transpose() * Eigen::Vector2d::UnitX();
  const Eigen::Matrix2d translation = part.information.topLeftCorner<2, 2>();
  const double along = (translation * axis).norm();
  const double across = (translation * Eigen::Vector2d(-axis.y(), axis.x())).norm();
  RC_ASSERT(along < 0.01 * across);
  RC_ASSERT(std::abs(part.weakest_direction_base.dot(axis)) > 0.99);
  const Pose2::Tangent error = part.T_map_base.minus(truth);
  RC_ASSERT(std::abs(error.y()) < 0.01);
  RC_ASSERT(std::abs(error.z()) < 0.004);
  // Nothing but the prior holds it there: a tenth of the 0.5 m that a pull to standing still takes.
  RC_ASSERT(std::abs(error.x()) < 0.05);
}

TEST(MatchScan, MeanErrorAlongACorridorIsNoPullToZero) {
  // Over 60 trials the mean shift along the corridor must vanish within five standard errors and
  // stay below 3 mm for a displacement of 0.5 m: a bias to standing still would show as -x.
  const auto walls = testing::corridor_walls();
  const Eigen::Matrix3d prior = Eigen::Vector3d(400, 400, 400).asDiagonal();
  double sum = 0, sum2 = 0;
  constexpr int kTrials = 60;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    Rng rng(1000 + trial);
    LocalMap map = map_of(walls, 4.5, rng);
    const Pose2 truth(0.5, 0, 0);
    const auto points = testing::points_of(testing::scan_of(walls, truth, 4.5, kRangeSigma_m, rng));
    const double shift = map.match(points, truth, prior).T_map_base.x_m() - truth.x_m();
    sum += shift;
    sum2 += shift * shift;
  }
  const double mean = sum / kTrials;
  const double standard_error = std::sqrt((sum2 / kTrials - mean * mean) / kTrials);
  EXPECT_LT(std::abs(mean), 5 * standard_error);
  EXPECT_LT(std::abs(mean), 0.003);
}

TEST(MatchScan, TheUnseenDirectionKeepsThePrior) {
  Rng rng(5);
  const auto walls = testing::corridor_walls();
  LocalMap map = map_of(walls, 4.5, rng);
  const auto points = testing::points_of(testing::scan_of(walls, {}, 4.5, kRangeSigma_m, rng));
  const Pose2 prior_pose(0.25, 0.03, 0);
  const Eigen::Matrix3d prior = Eigen::Vector3d(2500, 2500, 2500).asDiagonal();
  const MatchResult result = map.match(points, prior_pose, prior);
  EXPECT_NEAR(result.T_map_base.x_m(), 0.25, 0.01);
  EXPECT_NEAR(result.T_map_base.y_m(), 0, 0.01);
}

TEST(MatchScan, WithoutOverlapSaysSo) {
  Rng rng(6);
  LocalMap map = map_of(testing::room(), 30, rng);
  const std::vector<Eigen::Vector2d> far(50, Eigen::Vector2d(500, 500));
  EXPECT_EQ(map.match(far, {}).status, MatchStatus::kNoOverlap);
  EXPECT_EQ(map.match({}, {}).status, MatchStatus::kNoOverlap);
}

TEST(MatchScan, OfAnotherRoomIsAPoorFit) {
  Rng rng(7);
  LocalMap map = map_of(testing::room(), 30, rng);
  std::vector<Eigen::Vector2d> noise;
  for (int i = 0; i < 300; ++i) noise.emplace_back(rng.uniform(-3, 4), rng.uniform(-2.5, 2.5));
  EXPECT_FALSE(map.match(noise, {}).is_usable());
}

TEST(ObservablePart, KeepsTheWholeInformationBelowItsFloor) {
  MatchResult match;
  match.status = MatchStatus::kConverged;
  match.information = Eigen::Vector3d(1e3, 2e3, 3e3).asDiagonal();
  ObservabilityParams params;
  params.translation_floor_m = params.rotation_floor_rad = 1e-4;
  const ObservableMatch part = observable_part(match, params);
  EXPECT_EQ(part.num_observable, 3);
  // 1 / (1/lambda + floor^2) with floor^2 = 1e-8 is lambda to 3e-5.
  EXPECT_LT((part.information - match.information).norm(), 1e-4 * match.information.norm());
}

TEST(ObservablePart, NeverClaimsMoreThanTheFloorAllows) {
  MatchResult match;
  match.status = MatchStatus::kConverged;
  match.information = 1e12 * Eigen::Matrix3d::Identity();
  const ObservabilityParams params;
  const ObservableMatch part = observable_part(match, params);
  EXPECT_LE(part.information(0, 0), 1 / (params.translation_floor_m * params.translation_floor_m));
  EXPECT_LE(part.information(2, 2), 1 / (params.rotation_floor_rad * params.rotation_floor_rad));
}

TEST(ObservablePart, StepsToTheScansOwnOptimumWhereItSees) {
  MatchResult match;
  match.status = MatchStatus::kConverged;
  match.information = Eigen::Vector3d(1e4, 1e4, 1e4).asDiagonal();
  match.gradient = Eigen::Vector3d(-100, 50, 0);  // optimum at +1 cm, -0.5 cm
  const ObservableMatch part = observable_part(match, {});
  EXPECT_NEAR(part.T_map_base.x_m(), 0.01, 1e-9);
  EXPECT_NEAR(part.T_map_base.y_m(), -0.005, 1e-9);
}

TEST(ObservablePart, InformationThatNoisyNormalsExplainDoesNotCount) {
  MatchResult match;
  match.status = MatchStatus::kConverged;
  match.information = Eigen::Vector3d(2e3, 1e5, 1e5).asDiagonal();
  EXPECT_EQ(observable_part(match, {}).num_observable, 3);
  match.spurious_information = Eigen::Vector3d(1e3, 0, 0).asDiagonal();
  EXPECT_EQ(observable_part(match, {}).num_observable, 2);
}

TEST(UnseenInformation, HoldsToTheFloorWhatIsNotSeenAndNothingElse) {
  MatchResult match;
  match.status = MatchStatus::kConverged;
  match.information = Eigen::Vector3d(0, 1e5, 1e5).asDiagonal();
  const ObservabilityParams params;
  const double held = 1 / (params.translation_floor_m * params.translation_floor_m);
  const Eigen::Matrix3d expected = Eigen::Vector3d(held, 0, 0).asDiagonal();
  EXPECT_LT((unseen_information(match, params) - expected).norm(), 1e-9 * held);
  match.information(0, 0) = 1e5;
  EXPECT_TRUE(unseen_information(match, params).isZero());
}

}  // namespace
}  // namespace corridor::matching
