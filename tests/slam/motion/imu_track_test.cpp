#include "slam/motion/imu_track.hpp"

#include <gtest/gtest.h>

namespace corridor::motion {
namespace {

Timestamp at(double time_s) { return timestamp_from_seconds(time_s); }

// Readings of 0.5 rad/s every 10 ms, over [from_s, to_s].
void add_turning(double from_s, double to_s, ImuTrack& track) {
  for (double t = from_s; t < to_s + 1e-9; t += 0.01) track.add(ImuSample{at(t), 0.5, 0, 0});
}

TEST(ImuTrack, IntegratesWhatTheReadingsSay) {
  ImuTrack track{ImuModel{}};
  add_turning(0, 1, track);
  track.advance_to(at(1));
  EXPECT_NEAR(track.delta().theta_rad, 0.5, 1e-9);
  EXPECT_NEAR(track.delta().duration_s, 1, 1e-9);
  EXPECT_EQ(track.delta().unmeasured_s, 0);
}

TEST(ImuTrack, AMomentBetweenTwoReadingsSplitsTheTimeOnce) {
  ImuTrack track{ImuModel{}};
  add_turning(0, 0.5, track);
  track.advance_to(at(0.506));
  EXPECT_NEAR(track.delta().theta_rad, 0.253, 1e-9);
  add_turning(0.51, 1, track);
  EXPECT_NEAR(track.delta().theta_rad, 0.5, 1e-9);
  EXPECT_NEAR(track.delta().duration_s, 1, 1e-9);
}

TEST(ImuTrack, AnImuThatStopsIsNotIntegratedOnHoweverOftenOneAsks) {
  ImuTrack track{ImuModel{}};
  add_turning(0, 1, track);
  for (double t = 1.1; t < 3.05; t += 0.1) track.advance_to(at(t));
  // Held for three intervals of 10 ms, then nobody knows.
  EXPECT_NEAR(track.delta().theta_rad, 0.5 + 0.03 * 0.5, 1e-9);
  EXPECT_NEAR(track.delta().unmeasured_s, 2 - 0.03, 1e-9);
  EXPECT_NEAR(track.delta().duration_s, 3, 1e-9);
}

TEST(ImuTrack, TheUncertaintyOfAGapDoesNotDependOnThePiecesItComesIn) {
  ImuTrack often{ImuModel{}}, once{ImuModel{}};
  add_turning(0, 1, often);
  add_turning(0, 1, once);
  for (double t = 1.1; t < 2.05; t += 0.1) often.advance_to(at(t));
  once.advance_to(at(2));
  EXPECT_NEAR(often.delta().covariance(0, 0), once.delta().covariance(0, 0), 1e-4);
  EXPECT_GT(once.delta().covariance(0, 0), 0.9);  // a radian a second may have gone unseen
}

TEST(ImuTrack, AReadingAfterAGapDoesNotStandForTheGap) {
  ImuTrack track{ImuModel{}};
  track.add(ImuSample{at(0), 0, 0, 0});
  track.add(ImuSample{at(0.01), 0, 0, 0});
  track.add(ImuSample{at(2.01), 1, 0, 0});
  EXPECT_NEAR(track.delta().theta_rad, ImuTrack::kMaxHold_s, 1e-9);
  EXPECT_NEAR(track.delta().unmeasured_s, 2 - ImuTrack::kMaxHold_s, 1e-9);
}

TEST(ImuTrack, KeepsTheVelocityThroughAGap) {
  ImuTrack track{ImuModel{}};
  for (double t = 0; t < 1.005; t += 0.01) track.add(ImuSample{at(t), 0, 1, 0});
  track.advance_to(at(2));
  EXPECT_NEAR(track.delta().velocity_mps.x(), 1.03, 1e-6);
}

TEST(ImuTrack, BeforeTheFirstReadingNothingIsKnown) {
  ImuTrack track{ImuModel{}};
  track.advance_to(at(5));
  EXPECT_FALSE(track.has_reading());
  EXPECT_EQ(track.delta().duration_s, 0);
}

}  // namespace
}  // namespace corridor::motion
