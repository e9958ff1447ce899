#include "slam/core/grid_map.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "slam/core/rng.hpp"

namespace corridor {
namespace {

RC_GTEST_PROP(GridMap, CentreOfACellLiesInThatCell, (std::uint64_t seed)) {
  Rng rng(seed);
  const GridMap map(rng.uniform(0.01, 0.5), {rng.uniform(-50, 50), rng.uniform(-50, 50)}, 40, 30);
  const int column = static_cast<int>(rng.below(40));
  const int row = static_cast<int>(rng.below(30));
  RC_ASSERT(map.cell_of(map.centre_m(column, row)) == Eigen::Vector2i(column, row));
}

TEST(GridMap, CellsBeginAtTheOriginAndCoverTheirLowerBorder) {
  const GridMap map(0.5, {-1, 2}, 4, 3);
  EXPECT_EQ(map.cell_of({-1, 2}), Eigen::Vector2i(0, 0));
  EXPECT_EQ(map.cell_of({-0.5, 2}), Eigen::Vector2i(1, 0));
  EXPECT_EQ(map.cell_of({-0.51, 2.49}), Eigen::Vector2i(0, 0));
  EXPECT_EQ(map.cell_of({-1.01, 1.99}), Eigen::Vector2i(-1, -1));
  EXPECT_EQ(map.centre_m(0, 0), Eigen::Vector2d(-0.75, 2.25));
}

TEST(GridMap, ContainsItsCellsOnly) {
  const GridMap map(0.5, {0, 0}, 4, 3);
  EXPECT_TRUE(map.contains(0, 0));
  EXPECT_TRUE(map.contains(3, 2));
  EXPECT_FALSE(map.contains(4, 2));
  EXPECT_FALSE(map.contains(3, 3));
  EXPECT_FALSE(map.contains(-1, 0));
  EXPECT_FALSE(map.contains(0, -1));
}

TEST(GridMap, EachCellIsItsOwn) {
  GridMap map(0.1, {0, 0}, 7, 5);
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 7; ++column) {
      map.at(column, row).hits = static_cast<float>(10 * column + row);
    }
  }
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 7; ++column) {
      EXPECT_EQ(map.at(column, row).hits, static_cast<float>(10 * column + row));
    }
  }
}

TEST(GridMap, StartsUnknownAndMayBeEmpty) {
  EXPECT_TRUE(GridMap().empty());
  EXPECT_TRUE(GridMap(0.1, {0, 0}, 0, 9).empty());
  const GridMap map(0.1, {0, 0}, 1, 1);
  EXPECT_FALSE(map.empty());
  EXPECT_EQ(map.at(0, 0), GridCell{});
  EXPECT_FALSE(map.at(0, 0).is_observed);
}

TEST(GridMapDeathTest, NegativeSizesBreakItsContract) {
  EXPECT_DEATH(GridMap(0, {0, 0}, 1, 1), "contract broken: resolution_m > 0");
  EXPECT_DEATH(GridMap(0.1, {0, 0}, -1, 1), "contract broken");
}

RC_GTEST_PROP(LogOdds, AndProbabilityAreInverse, (std::uint64_t seed)) {
  const double probability = Rng(seed).uniform(0.001, 0.999);
  RC_ASSERT(std::abs(probability_from_log_odds(log_odds_from_probability(probability)) -
                     probability) < 1e-14);
}

TEST(LogOdds, OfOneHalfIsZeroAndAreOddAboutIt) {
  EXPECT_EQ(log_odds_from_probability(0.5), 0);
  EXPECT_NEAR(log_odds_from_probability(0.9), -log_odds_from_probability(0.1), 1e-14);
  EXPECT_NEAR(log_odds_from_probability(0.75), std::log(3.0), 1e-14);
}

}  // namespace
}  // namespace corridor
