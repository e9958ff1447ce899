#include "baselines/karto/key_scan_rule.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "baselines/karto/running_buffer.hpp"

namespace corridor::karto {
namespace {

LaserScan four_beams(double stamp_s = 0) {
  LaserScan scan;
  scan.stamp = timestamp_from_seconds(stamp_s);
  scan.angle_increment_rad = 1.5707963267948966;
  scan.range_max_m = 20;
  scan.ranges_m = {2, 4, 15, 21};
  scan.is_valid = {1, 1, 1, 0};
  return scan;
}

KeyScan at(const Pose2& T_odom_base, double stamp_s = 0) {
  return {four_beams(stamp_s), T_odom_base, {}};
}

bool becomes_key(const Pose2& motion, double after_s = 1) {
  const Pose2 start(5, -2, 3);
  return is_key_scan(at(start), at(start * motion, after_s), {});
}

TEST(KeyScanRule, AsksForTwentyCentimetresOrTenDegreesOrAnHour) {
  EXPECT_FALSE(becomes_key({}));
  EXPECT_FALSE(becomes_key({0.19, 0, 0}));
  EXPECT_TRUE(becomes_key({0.21, 0, 0}));
  EXPECT_TRUE(becomes_key({-0.15, 0.15, 0}));
  EXPECT_FALSE(becomes_key({0, 0, 0.1739}));
  EXPECT_TRUE(becomes_key({0, 0, 0.1741}));
  EXPECT_TRUE(becomes_key({0, 0, -0.1741}));
  EXPECT_FALSE(becomes_key({}, 3599));
  EXPECT_TRUE(becomes_key({}, 3600));
}

// On one recorded key step the squared distance was 5e-7 m^2 short, and the original took it.
TEST(KeyScanRule, ToleratesAMillionthOfASquareMetre) {
  EXPECT_TRUE(becomes_key({std::sqrt(0.04 - 5e-7), 0, 0}));
  EXPECT_FALSE(becomes_key({std::sqrt(0.04 - 2e-6), 0, 0}));
}

TEST(KeyScanRule, MeasuresAtTheSensorNotAtTheBase) {
  LaserScan scan = four_beams();
  scan.T_base_lidar = Pose2(1.5, 0, 0);
  const KeyScan first(scan, Pose2(), {});
  // Turned by 0.15 rad, less than the limit, but the sensor moved by 0.22 m.
  EXPECT_TRUE(is_key_scan(first, KeyScan(scan, Pose2(0, 0, 0.15), {}), {}));
}

TEST(KeyScan, ItsReferenceIsTheMeanEndPointWithinTheThreshold) {
  const KeyScan scan = at(Pose2(1, 2, 0));
  EXPECT_LT((scan.reference_map_m() - Eigen::Vector2d(2, 4)).norm(), 1e-6);  // of (3, 2), (1, 6)
  KeyScan moved = scan;
  moved.set_T_map_sensor(Pose2(11, 2, 0));
  EXPECT_LT((moved.reference_map_m() - Eigen::Vector2d(12, 4)).norm(), 1e-6);
  const KeyScan without(four_beams(), Pose2(1, 2, 0), {12, false, true});
  EXPECT_EQ(without.reference_map_m(), Eigen::Vector2d(1, 2));
}

TEST(KeyScan, KeepsEndPointsOfNoReturnsWhereAsked) {
  EXPECT_EQ(at({}).points_map_m().rows(), 4);
  EXPECT_EQ(KeyScan(four_beams(), {}, {12, true, false}).points_map_m().rows(), 2);
}

TEST(KeyScan, WithoutABeamInRangeIsUnusableButFinite) {
  LaserScan scan = four_beams();
  scan.ranges_m = {std::numeric_limits<float>::quiet_NaN(), 1e30F,
                   std::numeric_limits<float>::infinity(), 21};
  scan.is_valid = {1, 1, 0, 0};
  const KeyScan key_scan(scan, Pose2(1, 2, 3), {});
  EXPECT_FALSE(key_scan.is_usable());
  EXPECT_EQ(key_scan.reference_map_m(), Eigen::Vector2d(1, 2));
  EXPECT_EQ(key_scan.points_map_m().rows(), 1);
}

TEST(RunningBuffer, IsTrimmedFromTheFrontByCountAndByDistance) {
  std::vector<Eigen::Vector2d> references;
  for (int i = 0; i < 100; ++i) references.emplace_back(0.3 * i, 0);
  EXPECT_EQ(trimmed_buffer({0, 9}, references, 70, 20), (Chain{0, 9}));
  EXPECT_EQ(trimmed_buffer({0, 99}, references, 70, 1e9), (Chain{30, 99}));
  // 66 steps of 0.3 m are 19.8 m.
  EXPECT_EQ(trimmed_buffer({0, 99}, references, 1000, 20), (Chain{33, 99}));
  EXPECT_EQ(trimmed_buffer({0, 99}, references, 1, 0), (Chain{99, 99}));
}

}  // namespace
}  // namespace corridor::karto
