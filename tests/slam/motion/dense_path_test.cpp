#include "slam/motion/dense_path.hpp"

#include <gtest/gtest.h>

namespace corridor::motion {
namespace {

constexpr double kExact = 1e-12;

ScanRecord record(double stamp_s, const Pose2& T_odom_base, bool is_key) {
  return {timestamp_from_seconds(stamp_s), T_odom_base, is_key};
}

TEST(DensePath, OfNoRecordsIsEmpty) { EXPECT_TRUE(dense_path({}, {}).empty()); }

TEST(DensePath, SpreadsTheCorrectionLinearlyOverTheScansBetweenTwoKeys) {
  // Odometry says 1 m per scan, the match at the fourth scan 6 m and 0.4 m to the left.
  const std::vector<ScanRecord> records = {
      record(0, Pose2(), true), record(1, Pose2(1, 0, 0), false), record(5, Pose2(2, 0, 0), false),
      record(6, Pose2(3, 0, 0), false), record(7, Pose2(4, 0, 0), true)};
  const Trajectory path = dense_path(records, {Pose2(), Pose2(6, 0.4, 0)});
  ASSERT_EQ(path.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(path[i].T_map_base.x_m(), 1.5 * static_cast<double>(i), kExact);
    EXPECT_NEAR(path[i].T_map_base.y_m(), 0.1 * static_cast<double>(i), kExact);
  }
}

TEST(DensePath, BlendsHeadingsTheShortWayRound) {
  const std::vector<ScanRecord> records = {record(0, Pose2(), true), record(1, Pose2(), false),
                                           record(2, Pose2(), true)};
  const Trajectory path = dense_path(records, {Pose2(0, 0, 3.1), Pose2(0, 0, -3.1)});
  EXPECT_NEAR(std::abs(path[1].T_map_base.theta_rad()), 3.14159265358979, 1e-9);
}

TEST(DensePath, FollowsTheOdometryAfterTheLastKey) {
  const std::vector<ScanRecord> records = {record(0, Pose2(5, 5, 1), true),
                                           record(1, Pose2(5, 5, 1) * Pose2(0.3, 0, 0.1), false)};
  const Trajectory path = dense_path(records, {Pose2(1, 2, 0)});
  EXPECT_NEAR(path[1].T_map_base.x_m(), 1.3, kExact);
  EXPECT_NEAR(path[1].T_map_base.y_m(), 2, kExact);
  EXPECT_NEAR(path[1].T_map_base.theta_rad(), 0.1, kExact);
}

TEST(DensePath, DoesNotDependOnTheFrameOfTheOdometry) {
  const Pose2 shift(40, -70, 2);
  std::vector<ScanRecord> records = {record(0, Pose2(), true), record(1, Pose2(1, 0.1, 0.2), false),
                                     record(2, Pose2(2, 0.4, 0.3), true)};
  const std::vector<Pose2> keys = {Pose2(), Pose2(2.2, 0.1, 0.1)};
  const Trajectory path = dense_path(records, keys);
  for (ScanRecord& r : records) r.T_odom_base = shift * r.T_odom_base;
  const Trajectory shifted = dense_path(records, keys);
  EXPECT_NEAR(path[1].T_map_base.minus(shifted[1].T_map_base).norm(), 0, 1e-9);
}

}  // namespace
}  // namespace corridor::motion
