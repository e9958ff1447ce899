#include "baselines/gmapping/hill_climb.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

#include "slam/core/rng.hpp"

namespace corridor::gmapping {
namespace {

TEST(HillClimb, TriesStepsHalvedFromFirstToLastAroundAMaximum) {
  std::vector<double> distances_m;
  const HillClimbResult result = hill_climb(Pose2(), HillClimbSteps{}, [&](const Pose2& pose) {
    if (pose.x_m() > 0) distances_m.push_back(pose.x_m());
    return -pose.translation_m().norm() - std::abs(pose.theta_rad());
  });
  EXPECT_EQ(result.T_map_base, Pose2());
  EXPECT_EQ(distances_m, (std::vector<double>{0.05, 0.025, 0.0125, 0.00625, 0.003125, 0.0015625}));
  EXPECT_EQ(result.num_evaluations, 1 + 6 * 6);
}

TEST(HillClimb, MovesToTheBestOfTheSixAndNotToTheFirstBetterOne) {
  std::vector<Pose2> tried;
  hill_climb(Pose2(), HillClimbSteps{.num_refinements = 0}, [&](const Pose2& pose) {
    tried.push_back(pose);
    return -std::abs(pose.x_m() - 0.05) - 3 * std::abs(pose.theta_rad() - 0.05);
  });
  // The first pass ends at theta = 0.05, around which the second begins.
  ASSERT_GT(tried.size(), 7u);
  EXPECT_DOUBLE_EQ(tried[7].theta_rad(), 0.05);
}

TEST(HillClimb, StaysOnAPlateau) {
  const Pose2 start(1, 2, 3);
  const HillClimbResult result =
      hill_climb(start, HillClimbSteps{}, [](const Pose2&) { return 0.0; });
  EXPECT_EQ(result.T_map_base, start);
  EXPECT_EQ(result.score, 0.0);
}

RC_GTEST_PROP(HillClimb, EndsWithinTheSmallestStepOfASmoothMaximum, (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2 peak(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
  const HillClimbSteps steps;
  const HillClimbResult result = hill_climb(Pose2(), steps, [&](const Pose2& pose) {
    const Eigen::Vector2d offset_m = pose.translation_m() - peak.translation_m();
    return -offset_m.squaredNorm() - std::pow(pose.theta_rad() - peak.theta_rad(), 2);
  });
  const double smallest = steps.linear_m / 32;
  RC_ASSERT(std::abs(result.T_map_base.x_m() - peak.x_m()) <= smallest);
  RC_ASSERT(std::abs(result.T_map_base.y_m() - peak.y_m()) <= smallest);
  RC_ASSERT(std::abs(result.T_map_base.theta_rad() - peak.theta_rad()) <= smallest);
}

}  // namespace
}  // namespace corridor::gmapping
