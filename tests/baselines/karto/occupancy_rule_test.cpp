#include "baselines/karto/occupancy_rule.hpp"

#include <gtest/gtest.h>

namespace corridor::karto {
namespace {

// One beam along x.
KeyScan beam(float range_m, bool is_valid = true) {
  LaserScan scan;
  scan.range_max_m = 12;
  scan.ranges_m = {range_m};
  scan.is_valid = {static_cast<std::uint8_t>(is_valid)};
  return {scan, Pose2(), {4.0, true, true}};
}

GridMap map_of(const std::vector<KeyScan>& scans, const Pose2& T_frame_map = {}) {
  return build_karto_map(scans, T_frame_map, 4.0, {});
}

GridCell cell_at(const GridMap& map, double x_m, double y_m) {
  const Eigen::Vector2i cell = map.cell_of({x_m, y_m});
  return map.at(cell.x(), cell.y());
}

TEST(KartoMap, ACellIsKnownFromThreeBeamsOn) {
  EXPECT_FALSE(cell_at(map_of({beam(2), beam(2)}), 2, 0).is_observed);
  const GridMap map = map_of({beam(2), beam(2), beam(2)});
  EXPECT_TRUE(cell_at(map, 2, 0).is_observed);
  EXPECT_EQ(cell_at(map, 2, 0).hits, 3);
  EXPECT_GT(cell_at(map, 2, 0).log_odds, 0);
  EXPECT_TRUE(cell_at(map, 1, 0).is_observed);
  EXPECT_LT(cell_at(map, 1, 0).log_odds, 0);
}

TEST(KartoMap, OccupiedMeansThatMoreThanATenthOfTheBeamsEndThere) {
  std::vector<KeyScan> scans(9, beam(3));
  scans.push_back(beam(2));
  // 1 of 10 is not more than a tenth; its log-odds relative to the threshold are zero.
  EXPECT_NEAR(cell_at(map_of(scans), 2, 0).log_odds, 0, 1e-6);
  scans.push_back(beam(2));
  EXPECT_GT(cell_at(map_of(scans), 2, 0).log_odds, 0);
}

TEST(KartoMap, BeamsBeyondTheThresholdClearUpToItAndNoReturnsNothing) {
  const GridMap map = map_of({beam(9), beam(9), beam(9), beam(1), beam(13, false)});
  EXPECT_LT(cell_at(map, 3.9, 0).log_odds, 0);
  EXPECT_EQ(cell_at(map, 4, 0).hits, 0);
  EXPECT_LT(map.num_columns(), 90);  // 4 m, not 9 or 13
  EXPECT_TRUE(map_of({beam(13, false)}).empty());
}

TEST(KartoMap, LiesInTheFrameThatIsAskedFor) {
  const GridMap map = map_of({beam(2), beam(2), beam(2)}, Pose2(10, 20, 1.5707963267948966));
  EXPECT_EQ(cell_at(map, 10, 22).hits, 3);
}

}  // namespace
}  // namespace corridor::karto
