#include "slam/motion/deskew.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace corridor::motion {
namespace {

// A wall at x = 3 m seen over +-60 degrees while the robot moves with a constant twist.
LaserScan sweep_of_wall(const Eigen::Vector3d& twist, double duration_s = 0.1) {
  LaserScan scan;
  scan.range_max_m = 20;
  scan.duration_s = duration_s;
  constexpr int kBeams = 121;
  scan.angle_min_rad = -std::numbers::pi / 3;
  scan.angle_increment_rad = 2 * std::numbers::pi / 3 / (kBeams - 1);
  scan.ranges_m.resize(kBeams);
  scan.is_valid.assign(kBeams, 1);
  for (std::size_t i = 0; i < kBeams; ++i) {
    const Pose2 T_start_now = Pose2::exp(twist * scan.beam_time_s(i));
    const double heading = T_start_now.theta_rad() + scan.angle_rad(i);
    scan.ranges_m[i] = static_cast<float>((3 - T_start_now.x_m()) / std::cos(heading));
  }
  return scan;
}

TEST(DeskewedPoints, PutAWallSeenInMotionBackOnItsLine) {
  const Eigen::Vector3d twist(1.0, 0.2, 1.5);
  const auto points = deskewed_points(sweep_of_wall(twist), twist, 20);
  ASSERT_EQ(points.size(), 121u);
  for (const Eigen::Vector2d& p : points) EXPECT_NEAR(p.x(), 3, 1e-5);
}

// Beam 0 was taken last: the robot's pose at the stamp is that of the sweep's end.
TEST(DeskewedPoints, PutAWallSeenByAClockwiseLidarBackOnItsLine) {
  const Eigen::Vector3d twist(1.0, 0.2, 1.5);
  const auto points = deskewed_points(sweep_of_wall(twist, -0.1), twist, 20);
  ASSERT_EQ(points.size(), 121u);
  for (const Eigen::Vector2d& p : points) EXPECT_NEAR(p.x(), 3, 1e-5);
}

TEST(DeskewedPoints, WithTheWrongTwistTheWallIsNotStraight) {
  const auto points = deskewed_points(sweep_of_wall({1.0, 0.2, 1.5}), {0, 0, 1e-9}, 20);
  double worst_m = 0;
  for (const Eigen::Vector2d& p : points) worst_m = std::max(worst_m, std::abs(p.x() - 3));
  EXPECT_GT(worst_m, 0.05);
}

TEST(DeskewedPoints, LeaveInvalidAndFarBeamsOut) {
  LaserScan scan = sweep_of_wall(Eigen::Vector3d::Zero());
  scan.is_valid[0] = 0;
  EXPECT_EQ(deskewed_points(scan, Eigen::Vector3d::Zero(), 20).size(), 120u);
  EXPECT_TRUE(deskewed_points(scan, Eigen::Vector3d::Zero(), 1).empty());
}

}  // namespace
}  // namespace corridor::motion
