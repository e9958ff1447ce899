#include "slam/motion/wheel_preintegration.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

#include "slam/core/rng.hpp"
#include "slam/motion/wheel_track.hpp"

namespace corridor::motion {
namespace {

Timestamp at(double time_s) { return timestamp_from_seconds(time_s); }

WheelDelta motion_of(const WheelTrack& track, double from_s, double to_s,
                     const WheelCalibration& calibration) {
  const double delay_s = calibration(kDelay);
  return track.between(*track.read(at(from_s), delay_s), *track.read(at(to_s), delay_s),
                       calibration);
}

// A robot that drives and turns unevenly, sampled every 20 ms from -1 s to 2 s.
class UnevenDrive {
 public:
  explicit UnevenDrive(Rng& rng)
      : speed_mps_(rng.uniform(-1, 1)), rate_radps_(rng.uniform(-1, 1)), phase_(rng.uniform(0, 6)) {
    Pose2 pose;
    for (int i = -50; i <= 100; ++i) {
      const double t = 0.02 * i;
      track_.add({at(t), pose, std::nullopt});
      const double speed = speed_mps_ * (1 + 0.5 * std::sin(3 * t + phase_));
      const double rate = rate_radps_ * (1 + 0.5 * std::cos(2 * t + phase_));
      pose = pose.plus(0.02 * Eigen::Vector3d(speed, 0, rate));
    }
  }
  [[nodiscard]] WheelDelta between(double from_s, double to_s, const WheelCalibration& c) const {
    return motion_of(track_, from_s, to_s, c);
  }

 private:
  double speed_mps_, rate_radps_, phase_;
  WheelTrack track_;
};

WheelCalibration random_calibration(Rng& rng) {
  WheelCalibration calibration = WheelCalibration::Zero();
  for (int i = 0; i < 3; ++i) calibration(i) = rng.normal(0, 0.05);
  calibration(kDelay) = rng.uniform(-0.1, 0.1);
  return calibration;
}

double difference(const Pose2& a, const Pose2& b) { return a.minus(b).norm(); }

RC_GTEST_PROP(WheelDelta, IsCorrectedToFirstOrderByAnotherCalibration, (std::uint64_t seed)) {
  Rng rng(seed);
  const UnevenDrive drive(rng);
  const WheelCalibration calibration = random_calibration(rng);
  const WheelDelta delta = drive.between(0.11, 0.83, calibration);
  constexpr double kStep = 1e-4;
  for (int i = 0; i < 4; ++i) {
    const WheelCalibration moved = calibration + kStep * WheelCalibration::Unit(i);
    const Pose2 exact = drive.between(0.11, 0.83, moved).at(moved);
    // Second order, and for the delay the twist's change from one sample to the next: against a
    // change near 1e-4.
    const double tolerance = i == kDelay ? 1e-5 : 1e-8;
    RC_ASSERT(difference(delta.at(moved), exact) < tolerance);
  }
}

RC_GTEST_PROP(WheelDelta, OfTwoPartsIsThatOfTheWhole, (std::uint64_t seed)) {
  Rng rng(seed);
  const UnevenDrive drive(rng);
  const WheelCalibration calibration = random_calibration(rng);
  WheelDelta parts = drive.between(0.1, 0.47, calibration);
  parts.append(drive.between(0.47, 0.9, calibration));
  const WheelDelta whole = drive.between(0.1, 0.9, calibration);
  // The sample interval that the cut divides has two chords instead of one.
  constexpr double kCut = 1e-5;
  RC_ASSERT(difference(parts.at(calibration), whole.at(calibration)) < kCut);
  RC_ASSERT(difference(parts.raw_T_i_j(), whole.raw_T_i_j()) < 1e-12);
  RC_ASSERT((parts.by_intrinsics() - whole.by_intrinsics()).cwiseAbs().maxCoeff() < 1e-3);
}

TEST(WheelDelta, UnequalWheelsTurnAStraightPathIntoAnArc) {
  WheelCalibration calibration = WheelCalibration::Zero();
  calibration(kUnbalance) = 0.1;
  WheelDelta delta(calibration);
  for (int i = 0; i < 1000; ++i) delta.append(Pose2(0.001, 0, 0));
  // 1 m on a circle of 10 m.
  EXPECT_NEAR(delta.at(calibration).theta_rad(), 0.1, 1e-9);
  EXPECT_NEAR(delta.at(calibration).x_m(), 10 * std::sin(0.1), 1e-6);
  EXPECT_NEAR(delta.at(calibration).y_m(), 10 * (1 - std::cos(0.1)), 1e-6);
}

TEST(WheelDelta, ADelayReadsTheWheelsLater) {
  WheelTrack track;
  for (int i = 0; i <= 20; ++i) track.add({at(0.1 * i), Pose2(0.01 * i * i, 0, 0), std::nullopt});
  WheelCalibration calibration = WheelCalibration::Zero();
  calibration(kDelay) = 0.2;
  // x = t^2: from 0.7 s to 1.2 s.
  EXPECT_NEAR(motion_of(track, 0.5, 1, calibration).raw_T_i_j().x_m(), 1.44 - 0.49, 1e-12);
}

TEST(WheelDelta, TheBaseGoesAroundAnAxleBehindIt) {
  WheelCalibration calibration = WheelCalibration::Zero();
  calibration(kAxleX) = -0.5;
  WheelDelta delta(calibration);
  delta.append(Pose2(0, 0, 1));
  const Pose2 moved = delta.base_motion(calibration);
  EXPECT_NEAR(moved.x_m(), 0.5 * std::cos(1.0) - 0.5, 1e-12);
  EXPECT_NEAR(moved.y_m(), 0.5 * std::sin(1.0), 1e-12);
  EXPECT_NEAR(moved.theta_rad(), 1, 1e-12);
}

// Samples that come later than what is read of them: each motion ends at a pose that was carried
// on, and the next one begins there.
RC_GTEST_PROP(WheelTrack, MotionsReadWhileItGrowsAddUpToTheWholeOdometry, (std::uint64_t seed)) {
  Rng rng(seed);
  WheelCalibration calibration = WheelCalibration::Zero();
  calibration(kDelay) = rng.uniform(-0.15, 0.3);
  const double lateness_s = rng.uniform(0, 0.1);
  WheelTrack track;
  Pose2 pose;
  std::optional<WheelReading> first, last;
  WheelDelta sum(calibration);
  double next_sample_s = -0.5;
  for (int scan = 0; scan <= 30; ++scan) {
    const double t = 0.1 * scan;
    for (; next_sample_s + lateness_s < t; next_sample_s += 0.05) {
      track.add({at(next_sample_s), pose, std::nullopt});
      // It starts, goes on, turns and brakes.
      const double speed = next_sample_s < 0.5 ? 0 : next_sample_s < 2 ? 1 : 0.2;
      pose = pose.plus(0.05 * Eigen::Vector3d(speed, 0, rng.uniform(-1, 1)));
    }
    const std::optional<WheelReading> now = track.read(at(t), calibration(kDelay));
    RC_ASSERT(now.has_value());
    if (last) sum.append(track.between(*last, *now, calibration));
    if (!first) first = now;
    last = now;
  }
  RC_ASSERT(difference(sum.raw_T_i_j(), first->T_odom_axle.between(last->T_odom_axle)) < 1e-9);
}

TEST(WheelTrack, ReadsALongDelayAsFarAsItNeedsWhereTheLastSampleIsFresh) {
  WheelTrack track;
  track.add({at(0), Pose2(), std::nullopt});
  track.add({at(0.1), Pose2(0.1, 0, 0), std::nullopt});
  EXPECT_NEAR(track.read(at(0.3), 0.2)->T_odom_axle.x_m(), 0.5, 1e-12);
  EXPECT_FALSE(track.read(at(0.5), -0.2).has_value());
}

TEST(WheelTrack, OfTwoSamplesWithOneStampTheLaterCounts) {
  WheelTrack track;
  for (const double x_m : {0.0, 0.1, 0.2}) {
    track.add({at(x_m < 0.15 ? x_m : 0.1), Pose2(x_m, 0, 0), std::nullopt});
  }
  EXPECT_NEAR(track.read(at(0.2), 0)->T_odom_axle.x_m(), 0.4, 1e-12);
}

}  // namespace
}  // namespace corridor::motion
