#include "baselines/gmapping/gmapping_slam.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "baselines/gmapping/scan_points.hpp"
#include "tests/support/room_drive.hpp"

namespace corridor::gmapping {
namespace {

struct SlamRun {
  std::vector<Pose2> online;
  SlamEstimate estimate;
};

SlamRun run(const SensorLog& log, std::uint64_t seed, int num_threads = 1,
            const GmappingParams& params = {}) {
  const auto slam = make_gmapping(params, log.robot, Rng(seed), num_threads);
  SlamRun result;
  for (const SensorEvent& event : log.events) {
    const Result<StepReport> report = slam->step(event);
    EXPECT_TRUE(report.has_value()) << report.error().to_line();
    if (std::holds_alternative<LaserScan>(event)) {
      EXPECT_TRUE(report->T_map_base.has_value());
      result.online.push_back(report->T_map_base.value_or(Pose2()));
    }
  }
  Result<SlamEstimate> estimate = slam->finish();
  EXPECT_TRUE(estimate.has_value());
  result.estimate = std::move(*estimate);
  return result;
}

// Bit for bit.
void expect_same(const SlamRun& a, const SlamRun& b) {
  EXPECT_EQ(a.online, b.online);
  ASSERT_EQ(a.estimate.trajectory.size(), b.estimate.trajectory.size());
  for (std::size_t i = 0; i < a.estimate.trajectory.size(); ++i) {
    EXPECT_EQ(a.estimate.trajectory[i].T_map_base, b.estimate.trajectory[i].T_map_base) << i;
  }
  EXPECT_EQ(a.estimate.map, b.estimate.map);
  EXPECT_EQ(a.estimate.counters, b.estimate.counters);
}

// Small gates and few particles: many updates and resamplings in a short log.
GmappingParams eager_params() {
  GmappingParams params;
  params.num_particles = 8;
  params.linear_update_m = 0.2;
  params.angular_update_rad = 0.2;
  params.resample_threshold_ratio = 0.99;
  params.beam_tilt_steps = 0;
  return params;
}

TEST(Gmapping, TracksARoomThatTheOdometryMisjudgesByThreePercent) {
  const SensorLog log = testing::room_log();
  GmappingParams params = eager_params();
  params.num_particles = 30;
  params.resample_threshold_ratio = 0.5;
  const SlamRun result = run(log, 1, 1, params);
  const Trajectory& truth = *log.truth;
  ASSERT_EQ(result.estimate.trajectory.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    // One cell: the map's resolution.
    EXPECT_LT((result.estimate.trajectory[i].T_map_base.translation_m() -
               truth[i].T_map_base.translation_m())
                  .norm(),
              0.05)
        << i;
  }
  ASSERT_TRUE(result.estimate.map.has_value());
  EXPECT_FALSE(result.estimate.map->empty());
  EXPECT_GT(result.estimate.counters.at("key_scans"), 20);
}

TEST(Gmapping, AsPublishedTracksItTooAndAlikeWithAnyNumberOfThreads) {
  const SensorLog log = testing::room_log();
  GmappingParams params = published_params();
  params.num_particles = 8;
  params.linear_update_m = params.angular_update_rad = 0.2;
  params.beam_tilt_steps = 0;
  const SlamRun result = run(log, 1, 1, params);
  for (std::size_t i = 0; i < log.truth->size(); ++i) {
    EXPECT_LT((result.estimate.trajectory[i].T_map_base.translation_m() -
               (*log.truth)[i].T_map_base.translation_m())
                  .norm(),
              0.05)
        << i;
  }
  EXPECT_NE(result.estimate.trajectory.back().T_map_base,
            run(log, 2, 1, params).estimate.trajectory.back().T_map_base);
  expect_same(result, run(log, 1, 2, params));
}

TEST(Gmapping, GivesTheSameBytesForTheSameSeed) {
  const SensorLog log = testing::room_log();
  expect_same(run(log, 5, 1, eager_params()), run(log, 5, 1, eager_params()));
}

TEST(Gmapping, GivesTheSameBytesForAnyNumberOfThreads) {
  const SensorLog log = testing::room_log();
  const SlamRun one = run(log, 5, 1, eager_params());
  EXPECT_GT(one.estimate.counters.at("resamplings"), 0) << "tiles must have been shared";
  expect_same(one, run(log, 5, 2, eager_params()));
  expect_same(one, run(log, 5, 3, eager_params()));
}

TEST(Gmapping, DiffersBetweenSeeds) {
  const SensorLog log = testing::room_log();
  EXPECT_NE(run(log, 5, 1, eager_params()).online, run(log, 6, 1, eager_params()).online);
}

TEST(Gmapping, UsesOnlyTheFirstScanOfARobotThatStands) {
  SensorLog log = testing::room_log({.num_scans = 5});
  for (SensorEvent& event : log.events) {
    if (auto* wheel = std::get_if<WheelSample>(&event)) wheel->T_odom_base = Pose2(3, 4, 1);
  }
  const SlamRun result = run(log, 1);
  EXPECT_EQ(result.estimate.counters.at("key_scans"), 1);
  for (const Pose2& pose : result.online) EXPECT_LT(pose.minus(Pose2()).norm(), 1e-12);
}

TEST(Gmapping, UsesAScanWhenTheOdometryPathReachesTheUpdateDistance) {
  // Forth and back in steps of 0.3 m: the path counts, not the displacement.
  SensorLog log = testing::room_log({.num_scans = 9});
  int index = 0;
  for (SensorEvent& event : log.events) {
    if (auto* wheel = std::get_if<WheelSample>(&event)) {
      wheel->T_odom_base = Pose2(index++ % 2 == 0 ? 0.0 : 0.3, 0, 0);
    }
  }
  EXPECT_EQ(run(log, 1).estimate.counters.at("key_scans"), 3) << "scans 0, 4 and 8";
}

TEST(Gmapping, FollowsTheOdometryThroughScansWithoutValidBeams) {
  SensorLog log = testing::room_log({.odometry_scale = 1.0});
  for (SensorEvent& event : log.events) {
    if (auto* scan = std::get_if<LaserScan>(&event)) {
      std::fill(scan->is_valid.begin(), scan->is_valid.end(), std::uint8_t{0});
    }
  }
  const SlamRun result = run(log, 1);
  EXPECT_TRUE(result.estimate.map->empty());
  for (const Pose2& pose : result.online) EXPECT_TRUE(pose.is_finite());
  // Particles drift by their own noise only: decimetres after 8 m.
  EXPECT_LT(
      (result.online.back().translation_m() - log.truth->back().T_map_base.translation_m()).norm(),
      1.5);
}

TEST(Gmapping, StandsStillUntilTheFirstWheelSample) {
  SensorLog log = testing::room_log({.num_scans = 10});
  log.events.erase(log.events.begin() + 2);
  log.events.erase(log.events.begin());
  const SlamRun result = run(log, 1);
  ASSERT_EQ(result.online.size(), 10u);
  EXPECT_EQ(result.online[0], Pose2());
  EXPECT_EQ(result.online[1], Pose2());
}

TEST(Gmapping, OfNoEventsHasAnEmptyEstimate) {
  const SlamRun result = run(SensorLog{}, 1);
  EXPECT_TRUE(result.estimate.trajectory.empty());
  EXPECT_TRUE(result.estimate.map->empty());
}

TEST(Gmapping, ShrinksAFeaturelessCorridorAsTheOriginalDoes) {
  // 6 m along two parallel walls, range 4.5 m, perfect odometry: matches overlap most at rest.
  SensorLog log;
  log.robot.lidar.range_max_m = 4.5;
  Rng rng(4);
  for (int i = 0; i <= 120; ++i) {
    const Pose2 T_map_base(0.05 * i, 0, 0);
    const Timestamp stamp = timestamp_from_seconds(0.1 * i);
    log.events.emplace_back(WheelSample{stamp, T_map_base, std::nullopt});
    log.events.emplace_back(
        testing::scan_of(testing::corridor_walls(), T_map_base, 4.5, 0.015, rng, stamp));
  }
  const double end_m = run(log, 1).estimate.trajectory.back().T_map_base.x_m();
  EXPECT_LT(end_m, 5.9);
  EXPECT_GT(end_m, 3.0);
}

TEST(Gmapping, TurnsItsBeamsHalfAStepAsTheOriginalDoes) {
  LaserScan scan;
  scan.angle_increment_rad = 0.02;
  scan.ranges_m = {2.0F};
  scan.is_valid = {1};
  const ScanPoints points =
      usable_points(scan, {.max_range_m = 10, .tilt_steps = GmappingParams{}.beam_tilt_steps});
  EXPECT_NEAR(std::atan2(points.y_base_m[0], points.x_base_m[0]), -0.01, 1e-6);
}

}  // namespace
}  // namespace corridor::gmapping
