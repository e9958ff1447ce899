#include "datasets/formats/uniform_fan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace corridor::formats {
namespace {

const double kPi = std::acos(-1);
constexpr double kTight_rad = 1e-9;

// `n` beams of one turn from `start_rad` on, 1 ms apart; range 1 + i.
Sweep regular_sweep(std::size_t n, double start_rad) {
  Sweep sweep;
  for (std::size_t i = 0; i < n; ++i) {
    const double angle_rad = start_rad + 2 * kPi * static_cast<double>(i) / static_cast<double>(n);
    sweep.angles_rad.push_back(std::fmod(angle_rad, 2 * kPi));
    sweep.ranges_m.push_back(1.0 + static_cast<double>(i));
    sweep.times_us.push_back(1'000'000 + 1000 * static_cast<std::int64_t>(i));
  }
  return sweep;
}

constexpr std::size_t kNumBeams = 40;

struct Made {
  LaserScan scan;
  FanLosses losses;
};

// In the fan of a sensor whose turns begin at 0.3 rad.
Made make(const Sweep& sweep, bool is_clockwise, double range_max_m = 100) {
  Made made;
  const FanShape shape = fan_shape({regular_sweep(kNumBeams, 0.3)}, is_clockwise);
  made.scan = uniform_fan(sweep, shape, range_max_m, made.losses);
  return made;
}

TEST(UniformFan, CounterClockwiseBeamsKeepTheirOrderAnglesAndMoments) {
  const auto [scan, losses] = make(regular_sweep(40, 0.3), false);
  ASSERT_EQ(scan.num_beams(), 40U);
  EXPECT_EQ(scan.stamp.nanoseconds, 1'000'000'000);
  EXPECT_NEAR(scan.duration_s, 0.039, 1e-12);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(scan.ranges_m[i], 1.0F + static_cast<float>(i));
    EXPECT_NEAR(wrap_angle(scan.angle_rad(i) - 0.3 - 2 * kPi * static_cast<double>(i) / 40), 0,
                kTight_rad);
  }
  EXPECT_EQ(losses.num_shared_returns + losses.num_shared + losses.num_beyond_seam +
                losses.num_without_beam + losses.num_late,
            0U);
  EXPECT_LT(losses.max_moved_rad, kTight_rad);
}

TEST(UniformFan, ClockwiseBeamsAreMirroredAndBeamZeroIsTheLastTaken) {
  const Sweep sweep = regular_sweep(40, 0.3);
  const auto [scan, losses] = make(sweep, true);
  EXPECT_EQ(scan.stamp.nanoseconds, 1'039'000'000);
  EXPECT_NEAR(scan.duration_s, -0.039, 1e-12);
  for (std::size_t i = 0; i < 40; ++i) {
    const std::size_t beam = 39 - i;
    EXPECT_EQ(scan.ranges_m[i], static_cast<float>(sweep.ranges_m[beam]));
    EXPECT_NEAR(wrap_angle(scan.angle_rad(i) + sweep.angles_rad[beam]), 0, kTight_rad);
    EXPECT_NEAR(to_seconds(scan.stamp) + scan.beam_time_s(i),
                1e-6 * static_cast<double>(sweep.times_us[beam]), 1e-6);
  }
  EXPECT_EQ(losses.num_beyond_seam, 0U);
}

TEST(UniformFan, OfTwoBeamsInOneDirectionTheNearerStays) {
  Sweep sweep = regular_sweep(40, 0.3);
  sweep.angles_rad[11] = sweep.angles_rad[10] + 0.001;
  sweep.ranges_m[11] = 0.5;
  const auto [scan, losses] = make(sweep, false);
  EXPECT_EQ(losses.num_shared_returns, 1U);
  EXPECT_EQ(losses.num_without_beam, 1U);
  EXPECT_EQ(scan.ranges_m[10], 0.5F);
  EXPECT_EQ(scan.is_valid[11], 0);
  EXPECT_EQ(scan.ranges_m[11], 0.0F);
}

TEST(UniformFan, ABeamWithoutReturnDisplacesNone) {
  Sweep sweep = regular_sweep(40, 0.3);
  sweep.angles_rad[11] = sweep.angles_rad[10];
  sweep.ranges_m[11] = 0;
  const auto [scan, losses] = make(sweep, false);
  EXPECT_EQ(scan.ranges_m[10], 11.0F);
  EXPECT_EQ(scan.is_valid[10], 1);
  EXPECT_EQ(losses.num_shared, 1U);
  EXPECT_EQ(losses.num_shared_returns, 0U);
}

TEST(UniformFan, ZeroAndTooLongRangesAreNoReturnAndKeepTheirRawValue) {
  Sweep sweep = regular_sweep(40, 0.3);
  sweep.ranges_m[5] = 0;
  const auto [scan, losses] = make(sweep, false, 20.5);
  EXPECT_EQ(scan.is_valid[5], 0);
  EXPECT_EQ(scan.is_valid[19], 1);
  EXPECT_EQ(scan.is_valid[20], 0);
  EXPECT_EQ(scan.ranges_m[20], 21.0F);
}

// The turn began a little late: its last beam points where the next turn begins.
TEST(UniformFan, ABeamAcrossTheSeamIsLeftOutAndCounted) {
  Sweep sweep = regular_sweep(40, 0.0);
  const FanShape shape = fan_shape({sweep}, false);
  for (double& angle_rad : sweep.angles_rad) angle_rad = std::fmod(angle_rad + 0.16, 2 * kPi);
  FanLosses losses;
  const LaserScan scan = uniform_fan(sweep, shape, 100, losses);
  EXPECT_EQ(losses.num_beyond_seam, 1U);
  EXPECT_EQ(losses.num_without_beam, 1U);
  EXPECT_EQ(scan.is_valid[0], 0);
}

TEST(UniformFan, IrregularBeamsMoveByLessThanHalfAStepAndItIsSaid) {
  Sweep sweep = regular_sweep(40, 0.3);
  for (std::size_t i = 0; i < 40; i += 2) sweep.angles_rad[i] += 0.05;
  const auto [scan, losses] = make(sweep, false);
  EXPECT_EQ(losses.num_shared, 0U);
  EXPECT_NEAR(losses.max_moved_rad, 0.025, 1e-6);  // the phase is their mean
  EXPECT_NEAR(std::sqrt(losses.sum_moved_rad2 / 40), 0.025, 1e-6);
}

TEST(UniformFan, ASweepWithoutAnyReturnHasItsTimesAllTheSame) {
  Sweep sweep = regular_sweep(40, 0.3);
  sweep.ranges_m.assign(40, 0);
  const auto [scan, losses] = make(sweep, true);
  EXPECT_NEAR(scan.duration_s, -0.039, 1e-6);
  EXPECT_EQ(std::count(scan.is_valid.begin(), scan.is_valid.end(), 1), 0);
}

TEST(UniformFan, ItsShapeComesFromRegularStepsAndTheGapBetweenTurns) {
  Sweep sweep = regular_sweep(40, 0.3);
  // A lost beam, and one that points back.
  sweep.angles_rad.erase(sweep.angles_rad.begin() + 20);
  sweep.ranges_m.pop_back();
  sweep.times_us.pop_back();
  sweep.angles_rad[30] -= 0.2;
  const FanShape shape = fan_shape({sweep}, false);
  EXPECT_EQ(shape.num_beams, 40U);
  EXPECT_NEAR(shape.seam_rad, 0.3 - kPi / 40, kTight_rad);
}

TEST(UniformFan, OneBeamTellsNoShape) {
  EXPECT_EQ(fan_shape({}, true).num_beams, 0U);
  EXPECT_EQ(fan_shape({regular_sweep(1, 0)}, true).num_beams, 0U);
}

}  // namespace
}  // namespace corridor::formats
