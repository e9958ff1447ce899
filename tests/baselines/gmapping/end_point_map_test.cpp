#include "baselines/gmapping/end_point_map.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "slam/core/rng.hpp"

namespace corridor::gmapping {
namespace {

constexpr double kCellM = 0.05;

ScanPoints points_of(std::initializer_list<Eigen::Vector2f> list) {
  ScanPoints points;
  for (const Eigen::Vector2f& point : list) {
    points.x_base_m.push_back(point.x());
    points.y_base_m.push_back(point.y());
  }
  return points;
}

ScanPoints random_points(std::size_t count, double half_width_m, Rng& rng) {
  ScanPoints points;
  for (std::size_t i = 0; i < count; ++i) {
    points.x_base_m.push_back(static_cast<float>(rng.uniform(-half_width_m, half_width_m)));
    points.y_base_m.push_back(static_cast<float>(rng.uniform(-half_width_m, half_width_m)));
  }
  return points;
}

TEST(EndPointMap, HasNothingBeforeTheFirstPoint) {
  const EndPointMap map(kCellM);
  EXPECT_EQ(map.hits(0, 0), 0u);
  EXPECT_EQ(map.tile_of(0, 0), nullptr);
  EXPECT_GE(map.nearest_m2(0, 0, 1), kNotFoundM2);
  EXPECT_GE(map.nearest_of_nine_m2(0, 0, 5, 5), kNotFoundM2);
}

TEST(EndPointMap, KeepsTheMeanAndTheNumberOfThePointsOfACell) {
  EndPointMap map(kCellM);
  map.insert(points_of({{0.01F, 0.01F}, {0.03F, 0.01F}, {0.02F, 0.04F}, {0.06F, 0.01F}}), Pose2());
  EXPECT_EQ(map.hits(0, 0), 3u);
  EXPECT_NEAR(map.mean_m(0, 0).x(), 0.02, 1e-7);
  EXPECT_NEAR(map.mean_m(0, 0).y(), 0.02, 1e-7);
  EXPECT_EQ(map.hits(1, 0), 1u);
}

TEST(EndPointMap, InsertsThePointsAsSeenFromThePose) {
  EndPointMap map(kCellM);
  map.insert(points_of({{1.0F, 0.0F}}), Pose2(-3.01, 0.52, 1.5707963267948966));
  EXPECT_EQ(map.hits(-61, 30), 1u);
  EXPECT_NEAR(map.mean_m(-61, 30).x(), -3.01, 1e-6);
  EXPECT_NEAR(map.mean_m(-61, 30).y(), 1.52, 1e-6);
}

TEST(EndPointMap, AWriteInOneCopyNeverShowsInAnother) {
  EndPointMap original(kCellM);
  original.insert(points_of({{0.01F, 0.01F}, {5.0F, 5.0F}}), Pose2());
  EndPointMap copy = original;
  ASSERT_EQ(copy.tile_of(0, 0), original.tile_of(0, 0));
  copy.insert(points_of({{0.03F, 0.03F}}), Pose2());
  EXPECT_EQ(original.hits(0, 0), 1u);
  EXPECT_EQ(copy.hits(0, 0), 2u);
  EXPECT_NEAR(original.mean_m(0, 0).x(), 0.01, 1e-7);
  EXPECT_NE(copy.tile_of(0, 0), original.tile_of(0, 0));
  EXPECT_EQ(copy.tile_of(100, 100), original.tile_of(100, 100)) << "untouched tiles stay shared";
}

TEST(EndPointMap, WritesInPlaceOnceATileIsItsOwn) {
  EndPointMap map(kCellM);
  map.insert(points_of({{0.01F, 0.01F}}), Pose2());
  const Tile* tile = map.tile_of(0, 0);
  { const EndPointMap short_lived_copy = map; }
  map.insert(points_of({{0.02F, 0.02F}}), Pose2());
  EXPECT_EQ(map.tile_of(0, 0), tile);
}

TEST(EndPointMap, KeepsEveryCellWhenItGrowsInAllDirections) {
  EndPointMap map(kCellM);
  const ScanPoints corners =
      points_of({{0.0F, 0.0F}, {60.0F, 1.0F}, {-70.0F, -1.0F}, {2.0F, 80.0F}, {-2.0F, -90.0F}});
  map.insert(corners, Pose2());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    EXPECT_EQ(map.hits(map.cell_index(corners.x_base_m[i]), map.cell_index(corners.y_base_m[i])),
              1u);
  }
}

RC_GTEST_PROP(EndPointMap, NearestOfNineEqualsAScanOverAllCells, (std::uint64_t seed)) {
  // 2 m across: the tile border at 0 and those at +-1.6 m are inside.
  Rng rng(seed);
  EndPointMap map(kCellM);
  map.insert(random_points(400, 2, rng), Pose2());
  for (int query = 0; query < 50; ++query) {
    const auto x_m = static_cast<float>(rng.uniform(-2.1, 2.1));
    const auto y_m = static_cast<float>(rng.uniform(-2.1, 2.1));
    const int column = map.cell_index(x_m);
    const int row = map.cell_index(y_m);
    float expected_m2 = kNotFoundM2;
    for (int c = -50; c <= 50; ++c) {
      for (int r = -50; r <= 50; ++r) {
        if (std::abs(c - column) > 1 || std::abs(r - row) > 1 || map.hits(c, r) == 0) continue;
        expected_m2 =
            std::min(expected_m2, (map.mean_m(c, r) - Eigen::Vector2f(x_m, y_m)).squaredNorm());
      }
    }
    const float found_m2 = map.nearest_of_nine_m2(x_m, y_m, column, row);
    if (expected_m2 >= kNotFoundM2) {
      RC_ASSERT(found_m2 >= kNotFoundM2);
    } else {
      RC_ASSERT(std::abs(found_m2 - expected_m2) <= 1e-6F * expected_m2 + 1e-12F);
    }
  }
}

// Points, cells and fronts at random, tile borders among them: the path of four cells at once
// against the one of single cells.
RC_GTEST_PROP(EndPointMap, FindsTheNearestWithAFreeFrontByBothPaths, (std::uint64_t seed)) {
  Rng rng(seed);
  EndPointMap map(0.05);
  ScanPoints points;
  for (int i = 0; i < 1500; ++i) {
    points.x_base_m.push_back(static_cast<float>(rng.uniform(-2, 2)));
    points.y_base_m.push_back(static_cast<float>(rng.uniform(-2, 2)));
  }
  map.insert(points, Pose2());
  for (int i = 0; i < 200; ++i) {
    const auto x_m = static_cast<float>(rng.uniform(-2.2, 2.2));
    const auto y_m = static_cast<float>(rng.uniform(-2.2, 2.2));
    const Eigen::Vector2i front(static_cast<int>(rng.below(3)) - 1,
                                static_cast<int>(rng.below(3)) - 1);
    if (front == Eigen::Vector2i::Zero()) continue;
    const float fast = map.nearest_of_nine_with_free_front_m2(x_m, y_m, map.cell_index(x_m),
                                                              map.cell_index(y_m), front);
    const float plain = map.nearest_with_free_front_m2(x_m, y_m, 1, front);
    RC_ASSERT((fast < kNotFoundM2) == (plain < kNotFoundM2));
    if (plain < kNotFoundM2) RC_ASSERT(std::abs(fast - plain) <= 1e-6F);
  }
}

}  // namespace
}  // namespace corridor::gmapping
