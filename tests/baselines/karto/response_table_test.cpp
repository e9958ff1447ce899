// Formulas on tables small enough to compute by hand.
#include "baselines/karto/response_table.hpp"

#include <gtest/gtest.h>

namespace corridor::karto {
namespace {

constexpr double kExact = 1e-12;
constexpr SearchAxis kPosition_m{0.02, 0.02};  // -0.02, 0, 0.02
constexpr SearchAxis kHeading_rad{0.1, 0.1};   // -0.1, 0, 0.1

TEST(SearchAxis, CountsBothEnds) {
  EXPECT_EQ((SearchAxis{0.15, 0.02}.count()), 16);
  EXPECT_EQ((SearchAxis{4.0, 0.1}.count()), 81);
  EXPECT_EQ((SearchAxis{0.349, 0.0349}.count()), 21);
}

TEST(MeanBestOffset, AveragesAllPosesThatTieForTheBest) {
  ResponseTable table(kPosition_m, kHeading_rad);
  table.at(2, 1, 0) = 0.7;
  table.at(1, 2, 2) = 0.7 - 5e-7;  // equal within 1e-6
  table.at(0, 0, 0) = 0.7 - 5e-6;  // not
  const SearchOffset best = mean_best_offset(table, table.best_response());
  EXPECT_NEAR(best.position_m.x(), 0.0, kExact);
  EXPECT_NEAR(best.position_m.y(), 0.01, kExact);
  EXPECT_NEAR(best.heading_rad, 0.05, kExact);
}

TEST(MeanBestOffset, IsTheCentreWhereNothingResponds) {
  const ResponseTable table(kPosition_m, kHeading_rad);
  const SearchOffset best = mean_best_offset(table, table.best_response());
  EXPECT_NEAR(best.position_m.norm() + std::abs(best.heading_rad), 0, kExact);
}

TEST(PositionalCovariance, IsTheWeightedMomentAroundTheBestDividedByIt) {
  ResponseTable table(kPosition_m, kHeading_rad);
  table.at(1, 1, 1) = 0.8;
  table.at(0, 1, 2) = 0.75;  // the best of its headings counts
  table.at(2, 1, 2) = 0.4;
  table.at(1, 2, 2) = 0.72;
  table.at(1, 0, 0) = 0.69;  // more than 0.1 below: left out
  const Eigen::Matrix2d covariance = positional_covariance(table, 0.8, {});
  const double weights = 0.8 + 0.75 + 0.72;
  EXPECT_NEAR(covariance(0, 0), 4e-4 * (0.75 + 0.72) / weights / 0.8, kExact);
  EXPECT_NEAR(covariance(1, 1), 4e-4 * 0.72 / weights / 0.8, kExact);
  EXPECT_NEAR(covariance(0, 1), 4e-4 * 0.72 / weights / 0.8, kExact);
  EXPECT_EQ(covariance(0, 1), covariance(1, 0));
}

TEST(PositionalCovariance, HasAFloorOfATenthOfTheStepSquared) {
  ResponseTable table(kPosition_m, kHeading_rad);
  table.at(1, 1, 1) = 0.5;
  const Eigen::Matrix2d covariance = positional_covariance(table, 0.5, {});
  EXPECT_NEAR(covariance(0, 0), 0.1 * 4e-4 / 0.5, kExact);
  EXPECT_NEAR(covariance(1, 1), 0.1 * 4e-4 / 0.5, kExact);
  EXPECT_EQ(covariance(0, 1), 0);
}

TEST(PositionalCovariance, IsFiveHundredSquareMetresWhereNothingResponds) {
  const ResponseTable table(kPosition_m, kHeading_rad);
  EXPECT_EQ(positional_covariance(table, 0, {}), 500 * Eigen::Matrix2d::Identity());
}

TEST(HeadingVariance, IsTheWeightedSquareAroundTheBest) {
  // Best at 0.1: (0.6 * 0.2^2 + 0.65 * 0.1^2) / (0.6 + 0.65 + 0.7); the first is just near enough.
  EXPECT_NEAR(heading_variance({0.6, 0.65, 0.7}, kHeading_rad, 0.7, 0.1, 9),
              (0.6 * 0.04 + 0.65 * 0.01) / 1.95, kExact);
  EXPECT_NEAR(heading_variance({0.5, 0.65, 0.7}, kHeading_rad, 0.7, 0.1, 9), 0.0065 / 1.35, kExact);
}

TEST(HeadingVariance, OfASinglePeakIsTheStepSquaredOverItsResponse) {
  EXPECT_NEAR(heading_variance({0, 0.8, 0}, kHeading_rad, 0.8, 0, 9), 0.01 / 0.8, kExact);
}

TEST(HeadingVariance, FallsBackWhereNothingResponds) {
  EXPECT_EQ(heading_variance({0, 0, 0}, kHeading_rad, 0, 0, 9), 9);
}

}  // namespace
}  // namespace corridor::karto
