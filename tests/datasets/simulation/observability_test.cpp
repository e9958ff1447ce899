#include "datasets/simulation/observability.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace corridor::simulation {
namespace {

using Hits = std::vector<std::optional<BeamHit>>;

// Normals of wall 0 along x, wall 1 along y, wall 2 along the diagonal.
const Eigen::Vector2d kNormals[] = {
    {0, 1}, {-1, 0}, {-std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2}};

Hits hits_on(std::initializer_list<std::pair<std::size_t, int>> wall_and_count) {
  Hits hits;
  for (const auto& [wall_index, count] : wall_and_count) {
    hits.insert(hits.end(), static_cast<std::size_t>(count),
                BeamHit{.range_m = 1.0, .normal = kNormals[wall_index]});
  }
  return hits;
}

TEST(DegenerateDirection, IsThatOfTheOnlyWallsSeen) {
  EXPECT_NEAR(*degenerate_direction_rad(hits_on({{0, 50}})), 0, 1e-9);
  EXPECT_NEAR(*degenerate_direction_rad(hits_on({{1, 50}})), std::numbers::pi / 2, 1e-9);
  EXPECT_NEAR(*degenerate_direction_rad(hits_on({{2, 50}})), std::numbers::pi / 4, 1e-9);
}

TEST(DegenerateDirection, IsNoneOnceMoreThanTwoPercentOfTheBeamsHitACrossWall) {
  EXPECT_TRUE(degenerate_direction_rad(hits_on({{0, 99}, {1, 1}})));
  EXPECT_FALSE(degenerate_direction_rad(hits_on({{0, 97}, {1, 3}})));
  EXPECT_FALSE(degenerate_direction_rad(hits_on({{0, 50}, {1, 50}})));
}

TEST(DegenerateDirection, BeamsWithoutReturnSayNothing) {
  Hits hits = hits_on({{0, 97}, {1, 3}});
  hits.insert(hits.end(), 1000, std::nullopt);
  EXPECT_FALSE(degenerate_direction_rad(hits));
  EXPECT_TRUE(degenerate_direction_rad(Hits(10, std::nullopt)));
}

TEST(DegenerateIntervals, JoinConsecutiveScansOfOneDirection) {
  DegenerateIntervals intervals;
  const double pi = std::numbers::pi;
  const std::optional<double> directions_rad[] = {std::nullopt, 0.0,          pi - 0.001, 0.001,
                                                  pi / 2,       std::nullopt, pi / 2};
  for (int i = 0; i < 7; ++i) intervals.add(timestamp_from_seconds(i), directions_rad[i]);
  ASSERT_EQ(intervals.intervals().size(), 3u);
  EXPECT_EQ(intervals.intervals()[0].begin_s, 1);
  EXPECT_EQ(intervals.intervals()[0].end_s, 3);
  EXPECT_EQ(intervals.intervals()[1].begin_s, 4);
  EXPECT_EQ(intervals.intervals()[1].end_s, 4);
  EXPECT_EQ(intervals.intervals()[2].begin_s, 6);
}

}  // namespace
}  // namespace corridor::simulation
