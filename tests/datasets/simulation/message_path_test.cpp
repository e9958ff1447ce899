#include "datasets/simulation/message_path.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/simulation/simulate.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

// Stamp minus moment of those that arrive, 10 ms apart from 1 s on.
std::vector<double> delays_s(const MessageParams& params, double offset_s, int num_moments) {
  MessagePath path(params, {}, offset_s, Rng(1));
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
  MessagePath path({.time_jitter_s = 0.1, .loss_ratio = 0.2}, {}, 0, Rng(3));
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
  MessagePath path({}, {}, -0.5, Rng(1));
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

// Two seconds of silence after ten seconds of speech on average: a sixth of the time.
TEST(MessagePath, IsSilentInOutagesOfTheStatedLengthAndFrequency) {
  MessagePath path({}, {.duration_s = 2, .interval_s = 10}, 0, Rng(5));
  constexpr int kNum = 1'000'000;  // 10 ms each
  int num_arrived = 0, num_outages = 0, silent = 0;
  for (int k = 0; k < kNum; ++k) {
    if (!path.stamp_of(timestamp_from_seconds(0.01 * k))) {
      ++silent;
      continue;
    }
    ++num_arrived;
    if (silent > 0) {
      EXPECT_GE(silent, 199);  // more where two follow each other with no message between them
      ++num_outages;
    }
    silent = 0;
  }
  EXPECT_NEAR(num_arrived, kNum * 10 / 12.0, 0.02 * kNum);
  EXPECT_NEAR(num_outages, 10'000 / 12.0, 100);
}

// Each sensor falls silent at its own times; what else was drawn stays as it was.
TEST(SensorClocks, OutagesTakeReadingsAwayAndChangeNone) {
  Scenario scenario;
  const Simulated whole = simulated_log(scenario, 4);
  scenario.outages = {.duration_s = 2, .interval_s = 8};
  const Simulated broken = simulated_log(scenario, 4);
  EXPECT_LT(broken.log.num_scans(), whole.log.num_scans());
  EXPECT_LT(broken.log.num_wheel_samples(), whole.log.num_wheel_samples());
  EXPECT_LT(broken.log.num_imu_samples(), whole.log.num_imu_samples());
  auto event = whole.log.events.begin();
  for (const SensorEvent& arrived : broken.log.events) {
    while (event != whole.log.events.end() &&
           (stamp_of(*event) != stamp_of(arrived) || event->index() != arrived.index())) {
      ++event;
    }
    ASSERT_NE(event, whole.log.events.end());
    if (const auto* imu = std::get_if<ImuSample>(&arrived)) {
      EXPECT_EQ(std::get<ImuSample>(*event).gyro_z_radps, imu->gyro_z_radps);
    }
    if (const auto* scan = std::get_if<LaserScan>(&arrived)) {
      EXPECT_EQ(std::get<LaserScan>(*event).ranges_m, scan->ranges_m);
    }
  }
}

}  // namespace
}  // namespace corridor::simulation::testing
