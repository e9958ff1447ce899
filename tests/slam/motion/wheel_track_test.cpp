#include "slam/motion/wheel_track.hpp"

#include <gtest/gtest.h>

namespace corridor::motion {
namespace {

WheelSample sample_at(double stamp_s, const Pose2& pose) {
  return {timestamp_from_seconds(stamp_s), pose, std::nullopt};
}

WheelTrack straight_track() {
  WheelTrack track;
  for (int i = 0; i <= 10; ++i) track.add(sample_at(0.1 * i, {0.05 * i, 0, 0}));
  return track;
}

TEST(WheelTrack, GivesASampleAtItsStamp) {
  EXPECT_EQ(*straight_track().pose_at(timestamp_from_seconds(0.3)), Pose2(0.05 * 3, 0, 0));
}

TEST(WheelTrack, InterpolatesBetweenSamples) {
  EXPECT_NEAR(straight_track().pose_at(timestamp_from_seconds(0.25))->x_m(), 0.125, 1e-12);
}

TEST(WheelTrack, CarriesOnWithTheLastTwistForAShortTime) {
  EXPECT_NEAR(straight_track().pose_at(timestamp_from_seconds(1.1))->x_m(), 0.55, 1e-12);
}

TEST(WheelTrack, SaysNothingLongAfterTheLastSample) {
  EXPECT_FALSE(straight_track().pose_at(timestamp_from_seconds(1.5)).has_value());
}

TEST(WheelTrack, SaysNothingWithoutSamples) {
  EXPECT_FALSE(WheelTrack().pose_at(Timestamp{}).has_value());
}

TEST(WheelTrack, FollowsAnArcBetweenSamples) {
  WheelTrack track;
  const Eigen::Vector3d twist(1, 0, 1);
  track.add(sample_at(0, {}));
  track.add(sample_at(1, Pose2::exp(twist)));
  const Pose2 half = *track.pose_at(timestamp_from_seconds(0.5));
  EXPECT_NEAR(half.minus(Pose2::exp(0.5 * twist)).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace corridor::motion
