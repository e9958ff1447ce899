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
  EXPECT_NEAR(*free_direction(hits_on({{0, 50}}))->direction_rad, 0, 1e-9);
  EXPECT_NEAR(*free_direction(hits_on({{1, 50}}))->direction_rad, std::numbers::pi / 2, 1e-9);
  EXPECT_NEAR(*free_direction(hits_on({{2, 50}}))->direction_rad, std::numbers::pi / 4, 1e-9);
}

TEST(DegenerateDirection, IsNoneOnceMoreThanTwoPercentOfTheBeamsHitACrossWall) {
  EXPECT_TRUE(free_direction(hits_on({{0, 99}, {1, 1}})));
  EXPECT_FALSE(free_direction(hits_on({{0, 97}, {1, 3}})));
  EXPECT_FALSE(free_direction(hits_on({{0, 50}, {1, 50}})));
}

TEST(DegenerateDirection, BeamsWithoutReturnSayNothing) {
  Hits hits = hits_on({{0, 97}, {1, 3}});
  hits.insert(hits.end(), 1000, std::nullopt);
  EXPECT_FALSE(free_direction(hits));
}

TEST(DegenerateDirection, IsNoneInParticularWhereNoWallIsHit) {
  const Hits person(5, BeamHit{.range_m = 1.0, .is_person = true});
  for (const Hits& hits : {Hits(10, std::nullopt), person}) {
    const auto free = free_direction(hits);
    ASSERT_TRUE(free);
    EXPECT_FALSE(free->direction_rad);
  }
}

TEST(DegenerateIntervals, JoinConsecutiveScansOfOneDirection) {
  DegenerateIntervals intervals;
  const double pi = std::numbers::pi;
  const FreeDirection every;
  const std::optional<FreeDirection> free[] = {std::nullopt,
                                               FreeDirection{0.0},
                                               FreeDirection{pi - 0.001},
                                               FreeDirection{0.001},
                                               FreeDirection{pi / 2},
                                               std::nullopt,
                                               FreeDirection{pi / 2},
                                               every,
                                               every,
                                               FreeDirection{pi / 2},
                                               std::nullopt};
  for (int i = 0; i < 11; ++i) intervals.add(timestamp_from_seconds(i), free[i]);
  ASSERT_EQ(intervals.intervals().size(), 5u);
  EXPECT_EQ(intervals.intervals()[0].begin_s, 1);
  EXPECT_EQ(intervals.intervals()[0].end_s, 3);
  EXPECT_EQ(intervals.intervals()[1].begin_s, 4);
  EXPECT_EQ(intervals.intervals()[1].end_s, 4);
  EXPECT_EQ(intervals.intervals()[2].begin_s, 6);
  EXPECT_EQ(intervals.intervals()[3].begin_s, 7);
  EXPECT_EQ(intervals.intervals()[3].end_s, 8);
  EXPECT_FALSE(intervals.intervals()[3].direction_rad);
  EXPECT_EQ(intervals.intervals()[4].begin_s, 9);
}

}  // namespace
}  // namespace corridor::simulation
