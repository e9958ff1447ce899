// Clocks, ticks and the order of sensors: what raw logs need before their numbers are readings.
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/formats/clock_line.hpp"
#include "datasets/formats/sensor_merge.hpp"
#include "datasets/formats/tick_odometry.hpp"
#include "slam/core/rng.hpp"

namespace corridor::formats {
namespace {

// A clock that is 100 us/s fast, read through delays of 200 us and more.
TEST(ClockLine, FindsOffsetAndDriftUnderDelaysThatAreNeverNegative) {
  Rng rng(3);
  std::vector<ClockPair> pairs;
  const auto logger_us = [](std::int64_t stamp_us) {
    return 1'400'000'000'000'000 + stamp_us - stamp_us / 10'000;
  };
  for (std::int64_t stamp_us = 5'000'000; stamp_us < 85'000'000; stamp_us += 50'000) {
    const double delay_us = 200 + 600 * std::abs(rng.normal());
    pairs.push_back({stamp_us, logger_us(stamp_us) + static_cast<std::int64_t>(delay_us)});
  }
  const auto line = clock_line(pairs);
  ASSERT_TRUE(line.has_value());
  EXPECT_NEAR(line->drift_ratio, -1e-4, 1e-6);
  for (const ClockPair& pair : pairs) {
    const auto early_us =
        static_cast<double>(logger_us(pair.stamp_us) - line->to_logger_us(pair.stamp_us));
    EXPECT_NEAR(early_us, -200, 30);
  }
}

TEST(ClockLine, TwoPairsAreALineAndOneIsNone) {
  const auto line = clock_line({{0, 1000}, {1'000'000, 1'001'100}});
  ASSERT_TRUE(line.has_value());
  EXPECT_EQ(line->to_logger_us(500'000), 501'050);
  EXPECT_FALSE(clock_line({{0, 1000}}).has_value());
  EXPECT_FALSE(clock_line({}).has_value());
}

WheelModel millimetre_wheels() {
  WheelModel wheels;
  wheels.track_m = 0.5;
  wheels.left_m_per_tick = 1e-3;
  wheels.right_m_per_tick = 1e-3;
  return wheels;
}

TEST(TickOdometry, DrivesAQuarterCircleExactlyAndBeginsAtTheOrigin) {
  TickOdometry odometry(millimetre_wheels());
  EXPECT_EQ(odometry.take({0}, {1000, -200}, "a")->T_odom_base, Pose2());
  // Radius 1 m to the left: the wheels roll 0.75 and 1.25 m per radian.
  const double quarter = std::acos(-1) / 2;
  const WheelTicks ticks{1000 + std::llround(750 * quarter), -200 + std::llround(1250 * quarter)};
  const auto sample = odometry.take({1'000'000'000}, ticks, "a");
  ASSERT_TRUE(sample.has_value());
  constexpr double kOneTick = 2e-3;
  EXPECT_NEAR(sample->T_odom_base.x_m(), 1, kOneTick);
  EXPECT_NEAR(sample->T_odom_base.y_m(), 1, kOneTick);
  EXPECT_NEAR(sample->T_odom_base.theta_rad(), quarter, kOneTick);
  EXPECT_EQ(sample->ticks->left, ticks.left);
}

TEST(TickOdometry, AJumpOfOneWheelIsRefusedThoughItMovesTheRobotNowhere) {
  TickOdometry odometry(millimetre_wheels());
  ASSERT_TRUE(odometry.take({0}, {0, 0}, "a:1").has_value());
  const auto jump = odometry.take({100'000'000}, {-(1LL << 30), 0}, "a:2");
  ASSERT_FALSE(jump.has_value());
  EXPECT_EQ(jump.error().to_line(),
            "a:2: a wheel rolls 1073741.824 m in 0.1000 s; expected at most 10 m/s");
}

TEST(MergeSensors, OrdersByStampAndKeepsEachSensorsOwnOrder) {
  ParsedLog log;
  log.add(ImuSample{{10}, 0, 0, 0}, 0);
  log.add(ImuSample{{30}, 0, 0, 0}, 1);
  log.add(ImuSample{{20}, 0, 0, 0}, 2);  // steps back within the sensor
  log.add(WheelSample{{5}, Pose2(), {}}, 3);
  log.add(WheelSample{{30}, Pose2(), {}}, 4);
  EXPECT_EQ(merge_sensors(log), 3U);
  EXPECT_EQ(log.origins, (std::vector<std::uint64_t>{3, 0, 1, 2, 4}));
  EXPECT_EQ(stamp_of(log.events[3]).nanoseconds, 20);
}

TEST(MergeSensors, LeavesALogInOrderAlone) {
  ParsedLog log;
  log.add(WheelSample{{5}, Pose2(), {}}, 0);
  log.add(ImuSample{{5}, 0, 0, 0}, 1);
  log.add(ImuSample{{6}, 0, 0, 0}, 2);
  EXPECT_EQ(merge_sensors(log), 0U);
  EXPECT_EQ(log.origins, (std::vector<std::uint64_t>{0, 1, 2}));
}

}  // namespace
}  // namespace corridor::formats
