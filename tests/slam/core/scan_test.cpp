#include "slam/core/scan.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace corridor {
namespace {

constexpr double kExact = 1e-12;

LaserScan quarter_scan() {
  LaserScan scan;
  scan.angle_min_rad = 0;
  scan.angle_increment_rad = std::numbers::pi / 4;
  scan.duration_s = 0.08;
  scan.T_base_lidar = Pose2(0.5, 0, std::numbers::pi / 2);
  scan.ranges_m = {2, 2, 2};
  scan.is_valid = {1, 1, 1};
  return scan;
}

TEST(LaserScan, BeamsTurnCounterClockwiseFromTheFirst) {
  const LaserScan scan = quarter_scan();
  EXPECT_EQ(scan.angle_rad(0), 0);
  EXPECT_NEAR(scan.angle_rad(2), std::numbers::pi / 2, kExact);
}

TEST(LaserScan, BeamTimesSpreadOverTheSweep) {
  const LaserScan scan = quarter_scan();
  EXPECT_EQ(scan.beam_time_s(0), 0);
  EXPECT_NEAR(scan.beam_time_s(1), 0.04, kExact);
  EXPECT_NEAR(scan.beam_time_s(2), 0.08, kExact);
}

TEST(LaserScan, SingleBeamIsTakenAtTheStamp) {
  LaserScan scan = quarter_scan();
  scan.ranges_m = {2};
  EXPECT_EQ(scan.beam_time_s(0), 0);
}

TEST(LaserScan, EndPointsAreInTheBaseFrame) {
  // The LiDAR sits half a metre ahead and looks to the left.
  const LaserScan scan = quarter_scan();
  EXPECT_NEAR((scan.point_base_m(0) - Eigen::Vector2d(0.5, 2)).norm(), 0, kExact);
  EXPECT_NEAR((scan.point_base_m(2) - Eigen::Vector2d(-1.5, 0)).norm(), 0, kExact);
}

}  // namespace
}  // namespace corridor
