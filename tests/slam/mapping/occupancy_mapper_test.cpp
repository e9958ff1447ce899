#include "slam/mapping/occupancy_mapper.hpp"

#include <gtest/gtest.h>

#include "tests/support/synthetic_scan.hpp"

namespace corridor::mapping {
namespace {

LaserScan one_beam(double angle_rad, double range_m, bool is_valid = true) {
  LaserScan scan;
  scan.angle_min_rad = angle_rad;
  scan.range_max_m = 5;
  scan.ranges_m = {static_cast<float>(range_m)};
  scan.is_valid = {static_cast<std::uint8_t>(is_valid)};
  return scan;
}

GridMap map_of(const LaserScan& scan, const Pose2& pose = {}, OccupancyMapperParams params = {}) {
  const PosedScan posed{pose, &scan};
  return build_occupancy_map({&posed, 1}, params);
}

TEST(OccupancyMapper, MarksTheEndOccupiedAndThePathFree) {
  const GridMap map = map_of(one_beam(0, 1.02), {0.01, 0.01, 0});
  const OccupancyMapperParams params;
  const Eigen::Vector2i end = map.cell_of({1.03, 0.01});
  EXPECT_FLOAT_EQ(map.at(end.x(), end.y()).log_odds, static_cast<float>(params.hit_log_odds));
  EXPECT_EQ(map.at(end.x(), end.y()).hits, 1);
  const Eigen::Vector2i start = map.cell_of({0.01, 0.01});
  for (int column = start.x(); column < end.x(); ++column) {
    EXPECT_FLOAT_EQ(map.at(column, end.y()).log_odds, static_cast<float>(params.miss_log_odds));
    EXPECT_EQ(map.at(column, end.y()).hits, 0);
  }
  EXPECT_FALSE(map.at(end.x() + 1, end.y()).is_observed);
}

// The robot turns left by half a turn while a clockwise LiDAR takes beams at +90 and -90 degrees,
// the latter first: both saw the same wall to the robot's left at the sweep's end.
TEST(OccupancyMapper, DrawsEachBeamOfASweepFromWhereItWasTaken) {
  LaserScan scan = one_beam(-std::acos(-1) / 2, 1.02);
  scan.angle_increment_rad = std::acos(-1);
  scan.ranges_m = {1.02F, 1.02F};
  scan.is_valid = {1, 1};
  scan.duration_s = -1;
  PosedScan posed{{0.01, 0.01, 0}, &scan, {0, 0, std::acos(-1)}};
  const auto hits_at = [&posed](double x_m, double y_m) {
    const GridMap map = build_occupancy_map({&posed, 1}, {});
    const Eigen::Vector2i cell = map.cell_of({x_m, y_m});
    return map.contains(cell.x(), cell.y()) ? map.at(cell.x(), cell.y()).hits : 0;
  };
  EXPECT_EQ(hits_at(0.01, -1.01), 2);
  posed.twist_base.setZero();
  EXPECT_EQ(hits_at(0.01, -1.01), 1);
  EXPECT_EQ(hits_at(0.01, 1.03), 1);
}

TEST(OccupancyMapper, PassesExactlyTheCellsOfADiagonal) {
  OccupancyMapperParams params;
  params.resolution_m = 1;
  // From (0.2, 0.3) to (3.2, 2.3): cells (0,0) (1,0) (1,1) (2,1) (2,2), by hand:
  // x = 1 at y = 0.83, y = 1 at x = 1.25, x = 2 at y = 1.5, y = 2 at x = 2.75, x = 3 at y = 2.17.
  const GridMap map =
      map_of(one_beam(std::atan2(2.0, 3.0), std::hypot(3.0, 2.0)), {0.2, 0.3, 0}, params);
  const std::vector<Eigen::Vector2d> free = {{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}};
  for (const Eigen::Vector2d& cell : free) {
    const Eigen::Vector2i c = map.cell_of(cell + Eigen::Vector2d(0.5, 0.5));
    EXPECT_LT(map.at(c.x(), c.y()).log_odds, 0) << cell.transpose();
  }
  const Eigen::Vector2i end = map.cell_of({3.5, 2.5});
  EXPECT_GT(map.at(end.x(), end.y()).log_odds, 0);
  int observed = 0;
  for (int row = 0; row < map.num_rows(); ++row) {
    for (int column = 0; column < map.num_columns(); ++column) {
      observed += map.at(column, row).is_observed ? 1 : 0;
    }
  }
  EXPECT_EQ(observed, 6);
}

TEST(OccupancyMapper, IgnoresBeamsWithoutReturnUnlessAsked) {
  EXPECT_TRUE(map_of(one_beam(0, 6, false)).empty());
  OccupancyMapperParams params;
  params.use_no_returns = true;
  const GridMap map = map_of(one_beam(0, 6, false), {}, params);
  const Eigen::Vector2i middle = map.cell_of({2.5, 0.01});
  EXPECT_LT(map.at(middle.x(), middle.y()).log_odds, 0);
  for (int row = 0; row < map.num_rows(); ++row) {
    for (int column = 0; column < map.num_columns(); ++column) {
      EXPECT_EQ(map.at(column, row).hits, 0);
    }
  }
}

TEST(OccupancyMapper, ClampsTheEvidence) {
  const LaserScan scan = one_beam(0, 1);
  const std::vector<PosedScan> scans(100, PosedScan{{}, &scan});
  const OccupancyMapperParams params;
  const GridMap map = build_occupancy_map(scans, params);
  const Eigen::Vector2i end = map.cell_of({1.0, 0});
  EXPECT_FLOAT_EQ(map.at(end.x(), end.y()).log_odds, static_cast<float>(params.max_abs_log_odds));
  EXPECT_EQ(map.at(end.x(), end.y()).hits, 100);
}

TEST(OccupancyMapper, CountsEveryValidBeamOnce) {
  Rng rng(4);
  const LaserScan scan = testing::scan_of(testing::room(), {0.3, 0.2, 0.7}, 30, 0.01, rng);
  const GridMap map = map_of(scan, {0.3, 0.2, 0.7});
  double hits = 0;
  for (int row = 0; row < map.num_rows(); ++row) {
    for (int column = 0; column < map.num_columns(); ++column) hits += map.at(column, row).hits;
  }
  EXPECT_EQ(hits, 360);
}

TEST(OccupancyMapper, NoScansGiveAnEmptyMap) { EXPECT_TRUE(build_occupancy_map({}, {}).empty()); }

}  // namespace
}  // namespace corridor::mapping
