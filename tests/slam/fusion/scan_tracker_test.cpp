#include "slam/fusion/scan_tracker.hpp"

#include <gtest/gtest.h>

#include "slam/motion/deskew.hpp"
#include "tests/support/synthetic_scan.hpp"

namespace corridor::fusion {
namespace {

class ScanTrackerTest : public ::testing::Test {
 protected:
  ScanTrackerTest() {
    for (int i = 0; i < 10; ++i) {
      const Pose2 T_room_base(-1 + 0.05 * i, 0, 0);
      submap_.insert(static_cast<std::uint32_t>(i), T_room_base, points_at(T_room_base));
    }
  }

  std::vector<Eigen::Vector2d> points_at(const Pose2& T_room_base) {
    return motion::deskewed_points(
        testing::scan_of(testing::room(), T_room_base, 30, 0.01, rng_, Timestamp{}),
        Eigen::Vector3d::Zero(), 30);
  }

  // A robot that truly moved 0.1 m straight on, by wheels and gyro that say otherwise.
  TrackedScan track(double wheels_m, double turn_rad, bool is_turn_by_gyro) {
    const Pose2 T_room_last(-0.55, 0, 0);
    Prediction prediction;
    prediction.T_last_now = Pose2(wheels_m, 0, turn_rad);
    prediction.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
    prediction.has_wheels = true;
    prediction.is_turn_by_gyro = is_turn_by_gyro;
    return track_scan(submap_, points_at(T_room_last * Pose2(0.1, 0, 0)), T_room_last, prediction,
                      robot_, params_, false);
  }

  Rng rng_{3};
  RobotModel robot_;
  FusionParams params_;
  Submap submap_{0, params_};
};

TEST_F(ScanTrackerTest, WheelsThatAgreeHaveASmallChiSquare) {
  const TrackedScan tracked = track(0.1, 0, false);
  ASSERT_TRUE(tracked.wheel_chi2.has_value());
  EXPECT_EQ(tracked.wheel_degrees_of_freedom, 3);
  EXPECT_LT(*tracked.wheel_chi2, 16);
}

TEST_F(ScanTrackerTest, TheWheelsAnswerForTheirOwnTurn) {
  EXPECT_GT(*track(0.1, 0.03, false).wheel_chi2, 100);
}

TEST_F(ScanTrackerTest, TheWheelsDoNotAnswerForTheTurnOfTheGyro) {
  const TrackedScan tracked = track(0.1, 0.03, true);
  EXPECT_EQ(tracked.wheel_degrees_of_freedom, 2);
  EXPECT_LT(*tracked.wheel_chi2, 14);
  // They do for their translation.
  EXPECT_GT(*track(0.2, 0.03, true).wheel_chi2, 50);
}

}  // namespace
}  // namespace corridor::fusion
