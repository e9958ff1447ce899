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
  std::vector<SurfacePiece> pieces;
  cut_surface(columns, kAnchorSpacing_m, pieces);
  Points kept;
  for (const SurfacePiece& piece : pieces) {
    if (!piece.faces(viewpoint_m)) continue;
    kept.insert(kept.end(), points_m.begin() + piece.begin, points_m.begin() + piece.end);
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
