// A drive straight ahead whose truth, or whose LiDAR, does not go with its wheels.
#include <gtest/gtest.h>

#include <stdexcept>

#include "datasets/formats/log_health.hpp"
#include "tests/datasets/formats/formats_support.hpp"
#include "tests/datasets/formats/health_support.hpp"

namespace corridor::formats {
namespace {

using test::all_lines;
using test::change_each;
using test::expect_suspicion;

LaserScan first_scan(const SensorLog& log) {
  for (const SensorEvent& event : log.events) {
    if (const auto* scan = std::get_if<LaserScan>(&event)) return *scan;
  }
  throw std::logic_error("no scan in the log");
}

// A drive of 20 s straight ahead at 0.5 m/s, with a true pose per scan.
SensorLog straight_log(double true_factor) {
  SensorLog log = test::small_log();
  const LaserScan scan = first_scan(log);
  log.events.clear();
  log.truth.emplace();
  for (int i = 0; i <= 200; ++i) {
    const Timestamp stamp = timestamp_from_seconds(0.1 * i);
    log.events.emplace_back(WheelSample{stamp, Pose2(0.05 * i, 0, 0), std::nullopt});
    LaserScan& here = std::get<LaserScan>(log.events.emplace_back(scan));
    here.stamp = stamp;
    here.ranges_m[1] = 1 + 1e-3F * static_cast<float>(i);
    EXPECT_TRUE(log.truth->append({stamp, Pose2(0.05 * i * true_factor, 0, 0), std::nullopt}));
  }
  return log;
}

TEST(LogSuspicions, SuspectsATruthInAnotherUnit) {
  EXPECT_TRUE(examine(straight_log(1)).suspicions.empty())
      << all_lines(examine(straight_log(1)).suspicions);
  EXPECT_TRUE(examine(straight_log(0.4)).suspicions.empty()) << "wheels that slip";
  expect_suspicion(straight_log(100), "truth: a path 100 times as long as that of the wheels");
  expect_suspicion(straight_log(100),
                   "truth: 200 steps faster than 10 m/s, the first until 0.100 s");
  expect_suspicion(straight_log(3.2808), "truth: a path 3.281 times as long");
  expect_suspicion(straight_log(0.001), "truth: a path 0.001 times as long");
}

TEST(LogSuspicions, ComparesTruthAndWheelsOverTheTimeTheyShare) {
  SensorLog log = straight_log(1);
  std::erase_if(log.events, [](const SensorEvent& event) {
    return std::holds_alternative<WheelSample>(event) && to_seconds(stamp_of(event)) > 4.05;
  });
  const LogHealth health = examine(log);
  EXPECT_NEAR(health.truth->common_wheel_path_m, 2, 1e-9);
  EXPECT_NEAR(health.truth->common_path_m, 2, 1e-9);
}

TEST(LogSuspicions, SuspectsATruthOfFewScans) {
  SensorLog log = straight_log(1);
  Trajectory truth;
  for (std::size_t i = 0; i < 90; ++i) EXPECT_TRUE(truth.append((*log.truth)[i]));
  log.truth = truth;
  expect_suspicion(log, "truth: 44.8 % of the scans have a true pose within 10 ms");
}

TEST(LogSuspicions, SuspectsALidarThatHangsOnlyWhileTheWheelsMove) {
  SensorLog log = straight_log(1);
  const auto freeze = [](LaserScan& scan) { scan.ranges_m[1] = 1; };
  change_each<LaserScan>(log, freeze);
  expect_suspicion(log,
                   "LiDAR: 201 scans until event 401 are exactly the same while the wheels "
                   "move 10.000 m");
  change_each<WheelSample>(log, [](WheelSample& sample) { sample.T_odom_base = Pose2(1, 2, 3); });
  log.truth.reset();
  EXPECT_TRUE(examine(log).suspicions.empty()) << all_lines(examine(log).suspicions);
  SensorLog blind = straight_log(1);
  change_each<LaserScan>(blind, [&](LaserScan& scan) {
    freeze(scan);
    scan.is_valid.assign(scan.num_beams(), 0);
  });
  EXPECT_EQ(examine(blind).lidar->num_frozen_scans, 0U);
}

TEST(LogSuspicions, KnowsNoSpeedWhereNoTimePasses) {
  SensorLog log = straight_log(1);
  log.events.resize(2);
  EXPECT_FALSE(examine(log).wheels->max_speed_mps.has_value());
  SensorLog squeezed = straight_log(1);
  change_each<WheelSample>(squeezed, [](WheelSample& s) { s.stamp.nanoseconds /= 1000; });
  EXPECT_NEAR(*examine(squeezed).wheels->max_speed_mps, 500, 1e-6);
}

}  // namespace
}  // namespace corridor::formats
