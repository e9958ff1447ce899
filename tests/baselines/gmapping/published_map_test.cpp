#include "baselines/gmapping/published_map.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace corridor::gmapping {
namespace {

const GridCell& cell_at(const GridMap& map, double x_m, double y_m) {
  const Eigen::Vector2i cell = map.cell_of({x_m, y_m});
  return map.at(cell.x(), cell.y());
}

TEST(PublishedMap, OfScansWithoutPointsIsEmpty) {
  EXPECT_TRUE(published_map({}, {}, {}).empty());
  const std::vector<UsedScan> scans(1);
  const std::vector<Pose2> path(1);
  EXPECT_TRUE(published_map(scans, path, {}).empty());
}

TEST(PublishedMap, OfOneBeamIsFreeUpToItsEndAndOccupiedThere) {
  const std::vector<UsedScan> scans = {{ScanPoints{{1.025F}, {0.025F}}, Pose2(0.025, 0.025, 0)}};
  const std::vector<Pose2> path(1);
  const GridMap map = published_map(scans, path, {});
  EXPECT_DOUBLE_EQ(map.resolution_m(), 0.05);
  EXPECT_FLOAT_EQ(cell_at(map, 1.025, 0.025).hits, 1);
  EXPECT_FLOAT_EQ(cell_at(map, 1.025, 0.025).log_odds, static_cast<float>(kMaxAbsLogOdds));
  int num_free = 0;
  for (int row = 0; row < map.num_rows(); ++row) {
    for (int column = 0; column < map.num_columns(); ++column) {
      num_free += map.at(column, row).is_observed && map.at(column, row).log_odds < 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(num_free, 20);
  EXPECT_FALSE(cell_at(map, 0.5, 0.075).is_observed);
}

TEST(PublishedMap, IsOccupiedExactlyAboveTheRatioOfHitsToVisits) {
  // One beam ends at 1 m; beams that pass that cell and end at 2 m turn it free.
  const auto log_odds_after = [](int num_passing) {
    UsedScan scan{ScanPoints{{1.025F}, {0.025F}}, Pose2(0.025, 0.025, 0)};
    for (int i = 0; i < num_passing; ++i) {
      scan.points.x_base_m.push_back(2.025F);
      scan.points.y_base_m.push_back(0.025F);
    }
    const std::vector<UsedScan> scans = {scan};
    const std::vector<Pose2> path(1);
    return cell_at(published_map(scans, path, {}), 1.025, 0.025).log_odds;
  };
  EXPECT_GT(log_odds_after(2), 0) << "1 / 3 > 0.25";
  EXPECT_NEAR(log_odds_after(3), 0, 1e-6) << "1 / 4 is the threshold";
  EXPECT_LT(log_odds_after(4), 0) << "1 / 5 < 0.25";
}

TEST(PublishedMap, PutsEachScanAtItsPose) {
  const UsedScan scan{ScanPoints{{1.0F}, {0.0F}}, Pose2()};
  const std::vector<UsedScan> scans = {scan, scan};
  const std::vector<Pose2> path = {Pose2(0.01, 0.01, 0), Pose2(3.01, 0.01, 1.5707963267948966)};
  const GridMap map = published_map(scans, path, {});
  EXPECT_FLOAT_EQ(cell_at(map, 1.01, 0.01).hits, 1);
  EXPECT_FLOAT_EQ(cell_at(map, 3.01, 1.01).hits, 1);
}

}  // namespace
}  // namespace corridor::gmapping
