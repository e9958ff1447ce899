#include "slam/fusion/scan_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

// How far along a corridor the match of a scan lies from its prediction, at most, in ten scans.
double slide_along_corridor_m(int hold_unseen_passes) {
  FusionParams params;
  params.hold_unseen_passes = hold_unseen_passes;
  Rng rng(5);
  const auto points_at = [&rng](const Pose2& T_corridor_base) {
    return motion::deskewed_points(
        testing::scan_of(testing::corridor_walls(), T_corridor_base, 4, 0.02, rng, Timestamp{}),
        Eigen::Vector3d::Zero(), 30);
  };
  Submap submap(0, params);
  for (int i = 0; i < 10; ++i) {
    const Pose2 T_corridor_base(0.2 * i, 0, 0);
    submap.insert(static_cast<std::uint32_t>(i), T_corridor_base, points_at(T_corridor_base));
  }
  double slide_m = 0;
  for (int i = 0; i < 10; ++i) {
    const Pose2 T_corridor_last(1.5 + 0.05 * i, 0, 0);
    Prediction prediction;
    prediction.T_last_now = Pose2(0.1, 0, 0.05);  // a turn that the scan corrects
    prediction.covariance = Eigen::Vector3d(1e-2, 1e-4, 1e-2).asDiagonal();
    const TrackedScan tracked =
        track_scan(submap, points_at(T_corridor_last * Pose2(0.1, 0, 0)), T_corridor_last,
                   prediction, RobotModel{}, params, false);
    if (!tracked.match || tracked.match->num_observable != 2) return 1;
    const double predicted_m = (T_corridor_last * prediction.T_last_now).x_m();
    slide_m = std::max(slide_m, std::abs(tracked.match->T_map_base.x_m() - predicted_m));
  }
  return slide_m;
}

TEST(ScanTracker, AMatchStaysAtThePredictionAlongWhatItDoesNotSee) {
  EXPECT_LT(slide_along_corridor_m(2), 0.002);
  EXPECT_GT(slide_along_corridor_m(0), 0.004);
}

MotionEstimate straight_on(double distance_m) {
  return {Pose2(distance_m, 0, 0), Eigen::Vector3d(1e-5, 1e-5, 4e-6).asDiagonal()};
}

// A robot that stands in a corridor where a box, half a metre wide, has moved 0.1 m away from it
// since the submap was made. By the wheels the robot has not moved.
class MovedBoxTest : public ::testing::Test {
 protected:
  MovedBoxTest() {
    for (std::uint32_t i = 0; i < 10; ++i) submap_.insert(i, Pose2(), points_with_box_at(2.0));
    prediction_.has_wheels = true;
    prediction_.covariance = straight_on(0).covariance;
    prediction_.by_wheels = straight_on(0);
  }

  std::vector<Eigen::Vector2d> points_with_box_at(double x_m) {
    std::vector<testing::Wall> walls = testing::corridor_walls();
    walls.push_back({{x_m, -0.25}, {x_m, 0.25}});
    return motion::deskewed_points(testing::scan_of(walls, Pose2(), 4, 0.01, rng_),
                                   Eigen::Vector3d::Zero(), 30);
  }

  TrackedScan track(Submap& submap) {
    return track_scan(submap, points_with_box_at(2.1), Pose2(), prediction_, robot_, params_, true);
  }

  Rng rng_{7};
  RobotModel robot_;
  FusionParams params_;
  Submap submap_{0, params_};
  Prediction prediction_;
};

TEST_F(MovedBoxTest, DragsTheRobotWhereOnlyTheWheelsContradict) {
  const TrackedScan tracked = track(submap_);
  EXPECT_EQ(tracked.num_outvoted, 0);
  EXPECT_LT(tracked.T_submap_base.x_m(), -0.03);
}

TEST_F(MovedBoxTest, DoesNotDragTheRobotWhereTheImuSaysTheSameAsTheWheels) {
  prediction_.by_imu = straight_on(0);
  const TrackedScan tracked = track(submap_);
  EXPECT_EQ(tracked.num_outvoted, 1);
  EXPECT_EQ(tracked.match->num_observable, 2);
  EXPECT_NEAR(tracked.T_submap_base.x_m(), 0, 0.002);
}

TEST_F(MovedBoxTest, IsBelievedWhereTheImuSaysWhatItShows) {
  prediction_.by_imu = straight_on(-0.1);
  EXPECT_EQ(track(submap_).num_outvoted, 0);
}

TEST_F(MovedBoxTest, ThereIsNothingToVoteOnInAnEmptySubmap) {
  prediction_.by_imu = straight_on(0);
  Submap empty(0, params_);
  const TrackedScan tracked = track(empty);
  EXPECT_FALSE(tracked.match.has_value());
  EXPECT_EQ(tracked.num_outvoted, 0);
  EXPECT_EQ(tracked.T_submap_base.x_m(), 0);
}

}  // namespace
}  // namespace corridor::fusion
