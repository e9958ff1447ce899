#include "baselines/karto/valid_points.hpp"

#include <gtest/gtest.h>

namespace corridor::karto {
namespace {

using Points = std::vector<Eigen::Vector2d>;

Points facing(const Eigen::Vector2d& viewpoint_m, const Points& points_m) {
  PointColumns columns(static_cast<Eigen::Index>(points_m.size()), 2);
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    columns.row(static_cast<Eigen::Index>(i)) = points_m[i].transpose();
  }
  Surface surface;
  surface.cut(columns, kAnchorSpacing_m);
  std::vector<std::uint8_t> is_facing;
  surface.find_facing(viewpoint_m, is_facing);
  Points kept;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    if (is_facing[surface.piece_of_point()[i]] != 0) kept.push_back(points_m[i]);
  }
  return kept;
}

// A wall along x at y = 2 as a sensor at the origin sees it: beams turn left, so points run to -x.
const Points kWall = {{0.5, 2}, {0.45, 2}, {0.35, 2}, {0.3, 2}, {0.2, 2}, {0.15, 2}};

TEST(ValidPoints, KeepsASurfaceSeenFromTheSensorsSideUpToTheLastAnchor) {
  // Anchors: 0.5, then 0.35 (0.15 m on), then 0.2; what follows the last anchor is never kept.
  EXPECT_EQ(facing({0, 0}, kWall), Points(kWall.begin(), kWall.begin() + 4));
}

TEST(ValidPoints, DropsASurfaceSeenFromItsBack) { EXPECT_TRUE(facing({0, 3}, kWall).empty()); }

TEST(ValidPoints, KeepsASurfaceSeenEdgeOn) { EXPECT_EQ(facing({-1, 2}, kWall).size(), 4u); }

TEST(ValidPoints, JudgesEachPieceOfABentSurfaceAlone) {
  // First along the wall at y = 2, then down a wall at x = 0 whose front is at +x.
  const Points corner = {{0.4, 2}, {0.2, 2}, {0, 2}, {0, 1.8}, {0, 1.6}, {0, 1.4}};
  const Points kept = facing({-1, 0}, corner);
  EXPECT_EQ(kept, Points({{0.4, 2}, {0.2, 2}}));
}

TEST(ValidPoints, AnAnchorMustBeFartherThanTheSpacing) {
  EXPECT_TRUE(facing({0, 0}, {{0.1, 2}, {0.0, 2}}).empty());
  EXPECT_EQ(facing({0, 0}, {{0.1001, 2}, {0.0, 2}}).size(), 1u);
}

TEST(ValidPoints, FewerThanTwoPointsGiveNone) {
  EXPECT_TRUE(facing({0, 0}, {}).empty());
  EXPECT_TRUE(facing({0, 0}, {{1, 1}}).empty());
}

}  // namespace
}  // namespace corridor::karto
