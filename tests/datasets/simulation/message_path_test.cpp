#include "datasets/simulation/message_path.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/simulation/simulate.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

// Stamp minus moment of those that arrive, 10 ms apart from 1 s on.
std::vector<double> delays_s(const MessageParams& params, double offset_s, int num_moments) {
  MessagePath path(params, offset_s, Rng(1));
  std::vector<double> delays;
  for (int k = 0; k < num_moments; ++k) {
    const Timestamp moment = timestamp_from_seconds(1 + 0.01 * k);
    if (const auto stamp = path.stamp_of(moment)) {
      delays.push_back(seconds_between(moment, *stamp));
    }
  }
  return delays;
}

TEST(MessagePath, WithoutErrorsStampsTheMomentItself) {
  for (const double delay_s : delays_s({}, 0, 100)) EXPECT_EQ(delay_s, 0);
}

TEST(MessagePath, OffsetIsAddedToEveryStamp) {
  for (const double offset_s : {-0.037, 0.25}) {
    for (const double delay_s : delays_s({}, offset_s, 100)) EXPECT_NEAR(delay_s, offset_s, 1e-9);
  }
}

TEST(MessagePath, StampsStayInOrderHoweverLargeTheJitter) {
  MessagePath path({.time_jitter_s = 0.1, .loss_ratio = 0.2}, 0, Rng(3));
  Timestamp last{-1};
  int num_crowded = 0;
  for (int k = 0; k < 5000; ++k) {
    const auto stamp = path.stamp_of(timestamp_from_seconds(0.01 * k));
    if (!stamp) continue;
    ASSERT_GT(*stamp, last);
    num_crowded += stamp->nanoseconds - last.nanoseconds == 1000;
    last = *stamp;
  }
  EXPECT_GT(num_crowded, 100);
}

TEST(MessagePath, NothingIsStampedBeforeTheLogBegins) {
  MessagePath path({}, -0.5, Rng(1));
  EXPECT_FALSE(path.stamp_of(timestamp_from_seconds(0.4)));
  EXPECT_EQ(path.stamp_of(timestamp_from_seconds(0.6)), timestamp_from_seconds(0.1));
}

TEST(SensorClocks, LidarOffsetMovesItsStampsAndNothingElse) {
  Scenario scenario;
  const Simulated plain = simulated_log(scenario, 2);
  scenario.lidar.time_offset_s = 0.03;
  const Simulated moved = simulated_log(scenario, 2);
  EXPECT_EQ(moved.truth.lidar_time_offset_s, 0.03);
  EXPECT_EQ(moved.log.robot.lidar.time_offset_s, 0.03);
  ASSERT_EQ(plain.log.num_scans(), moved.log.num_scans());
  for (std::size_t k = 0; k < plain.log.num_scans(); ++k) {
    const TrajectoryPose& before = (*plain.log.truth)[k];
    const TrajectoryPose& after = (*moved.log.truth)[k];
    EXPECT_EQ(after.stamp.nanoseconds - before.stamp.nanoseconds, 30'000'000);
    EXPECT_EQ(after.T_map_base, before.T_map_base);
  }
}

TEST(SensorClocks, UnstatedPartOfAnOffsetIsInTheTruthAlone) {
  Scenario scenario;
  scenario.lidar.time_offset_s = 0.1;
  scenario.lidar.time_offset_sigma_s = 0.005;
  const Simulated simulated = simulated_log(scenario, 2);
  EXPECT_EQ(simulated.log.robot.lidar.time_offset_s, 0.1);
  EXPECT_NE(simulated.truth.lidar_time_offset_s, 0.1);
  EXPECT_NEAR(simulated.truth.lidar_time_offset_s, 0.1, 5 * 0.005);
}

// Ticks count on while messages are lost: those that arrive are those of a log without losses.
TEST(SensorClocks, LostWheelMessagesLoseNoPath) {
  Scenario scenario;
  const Simulated whole = simulated_log(scenario, 4);
  scenario.wheels.message.loss_ratio = 0.3;
  const Simulated lossy = simulated_log(scenario, 4);
  std::size_t num_compared = 0;
  auto event = whole.log.events.begin();
  for (const SensorEvent& arrived : lossy.log.events) {
    const auto* sample = std::get_if<WheelSample>(&arrived);
    if (sample == nullptr) continue;
    while (!std::holds_alternative<WheelSample>(*event) || stamp_of(*event) < sample->stamp) {
      ++event;
    }
    EXPECT_EQ(std::get<WheelSample>(*event).ticks->left, sample->ticks->left);
    ++num_compared;
  }
  const auto num_sent = static_cast<double>(whole.log.num_wheel_samples());
  EXPECT_NEAR(static_cast<double>(num_compared) / num_sent, 0.7,
              5 * std::sqrt(0.3 * 0.7 / num_sent));
}

}  // namespace
}  // namespace corridor::simulation::testing
