#include "baselines/karto/karto_slam.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "tests/support/room_drive.hpp"

namespace corridor::karto {
namespace {

std::unique_ptr<SlamSystem> make(const RobotModel& robot = {}, const KartoParams& params = {}) {
  return make_karto(params, robot, backend::make_least_squares(backend::spa_params()), 1);
}

struct Drive {
  SlamEstimate estimate;
  std::vector<StepReport> reports;  // of the scans
};

Drive run(const SensorLog& log, const KartoParams& params = {}) {
  const auto system = make(log.robot, params);
  Drive result;
  for (const SensorEvent& event : log.events) {
    const Result<StepReport> report = system->step(event);
    EXPECT_TRUE(report.has_value());
    if (report && report->T_map_base) result.reports.push_back(*report);
  }
  result.estimate = *system->finish();
  return result;
}

double largest_error_m(const Trajectory& trajectory, const Trajectory& truth) {
  double largest_m = 0;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    largest_m = std::max(
        largest_m,
        (trajectory[i].T_map_base.translation_m() - truth[i].T_map_base.translation_m()).norm());
  }
  return largest_m;
}

template <class Change>
SensorLog changed(SensorLog log, Change change) {
  for (SensorEvent& event : log.events) {
    if (auto* scan = std::get_if<LaserScan>(&event)) change(*scan);
  }
  return log;
}

TEST(KartoSlam, TracksADriveRoundARoomWhoseWheelsAreThreePercentWrong) {
  const SensorLog log = testing::room_log();
  const Drive result = run(log);
  ASSERT_EQ(result.estimate.trajectory.size(), 120u);
  // The wheels alone drift to 0.1 m and more; matching to cells of 1 cm does not.
  EXPECT_LT(largest_error_m(result.estimate.trajectory, *log.truth), 0.04);
  EXPECT_TRUE(std::all_of(result.reports.begin(), result.reports.end(),
                          [](const StepReport& r) { return r.status == StepStatus::kTracked; }));
  EXPECT_GT(result.estimate.counters.at("key_scans"), 30);
  EXPECT_FALSE(result.estimate.map->empty());
}

TEST(KartoSlam, StartsAtTheOriginWhateverTheOdometrysFrame) {
  SensorLog log = testing::room_log();
  for (SensorEvent& event : log.events) {
    if (auto* wheels = std::get_if<WheelSample>(&event)) {
      wheels->T_odom_base = Pose2(30, -20, 2) * wheels->T_odom_base;
    }
  }
  const Drive result = run(log);
  EXPECT_LT(result.estimate.trajectory.front().T_map_base.log().norm(), 1e-9);
  EXPECT_LT(result.reports.front().T_map_base->log().norm(), 1e-9);
  EXPECT_LT(largest_error_m(result.estimate.trajectory, *log.truth), 0.04);
}

TEST(KartoSlam, HandsOutTheGraphItSolvedInTheTrajectorysFrame) {
  const SensorLog log = testing::room_log();
  KartoSlam slam({}, log.robot, backend::make_least_squares(backend::spa_params()), 1);
  std::vector<std::size_t> key_scans;
  std::size_t num_scans = 0;
  for (const SensorEvent& event : log.events) {
    const StepReport report = *slam.step(event);
    if (!report.T_map_base) continue;
    if (report.is_key_scan) key_scans.push_back(num_scans);
    ++num_scans;
  }
  const SlamEstimate estimate = *slam.finish();
  ASSERT_EQ(slam.solved_values().size(), key_scans.size());
  EXPECT_GE(slam.solved_graph().num_factors(), key_scans.size());
  for (std::uint32_t i = 0; i < key_scans.size(); ++i) {
    const Pose2& in_trajectory = estimate.trajectory[key_scans[i]].T_map_base;
    EXPECT_LT(slam.solved_values().pose(i).minus(in_trajectory).norm(), 1e-9);
  }
}

TEST(KartoSlam, TheSameLogTwiceGivesTheSameBytes) {
  const SensorLog log = testing::room_log();
  const Drive first = run(log);
  const Drive second = run(log);
  ASSERT_EQ(first.reports.size(), second.reports.size());
  for (std::size_t i = 0; i < first.reports.size(); ++i) {
    EXPECT_EQ(*first.reports[i].T_map_base, *second.reports[i].T_map_base);
    EXPECT_EQ(first.estimate.trajectory[i].T_map_base, second.estimate.trajectory[i].T_map_base);
  }
  EXPECT_EQ(*first.estimate.map, *second.estimate.map);
}

TEST(KartoSlam, AMountedSensorGivesPosesOfTheBase) {
  // Turned and moved on the base; the room as the same sensor saw it.
  const Pose2 T_base_lidar(0.2, -0.1, 0.5);
  SensorLog log = testing::room_log();
  for (SensorEvent& event : log.events) {
    if (auto* scan = std::get_if<LaserScan>(&event)) scan->T_base_lidar = T_base_lidar;
    if (auto* wheels = std::get_if<WheelSample>(&event)) {
      wheels->T_odom_base = wheels->T_odom_base * T_base_lidar.inverse();
    }
  }
  const Trajectory bases = run(log).estimate.trajectory;
  for (std::size_t i = 0; i < bases.size(); ++i) {
    const Pose2 expected = T_base_lidar * (*log.truth)[i].T_map_base * T_base_lidar.inverse();
    EXPECT_LT((bases[i].T_map_base.translation_m() - expected.translation_m()).norm(), 0.05);
  }
}

TEST(KartoSlam, TheCorrectedProfileTracksTooWhereMostBeamsReturnNothing) {
  const SensorLog log = testing::room_log({.num_scans = 120, .range_max_m = 3.2});
  EXPECT_LT(largest_error_m(run(log, corrected_params()).estimate.trajectory, *log.truth), 0.1);
}

TEST(KartoSlam, AnEmptyLogGivesAnEmptyEstimate) {
  const Drive result = run({});
  EXPECT_TRUE(result.estimate.trajectory.empty());
}

TEST(KartoSlam, OneScanIsAMapOfItsOwn) {
  SensorLog log = testing::room_log();
  log.events.resize(2);
  const Drive result = run(log);
  ASSERT_EQ(result.estimate.trajectory.size(), 1u);
  EXPECT_EQ(result.estimate.counters.at("key_scans"), 1);
}

TEST(KartoSlam, ScansWithoutAnyReturnAreTrackedByOdometryAndCounted) {
  const SensorLog log = changed(testing::room_log(), [](LaserScan& scan) {
    std::fill(scan.is_valid.begin(), scan.is_valid.end(), std::uint8_t{0});
  });
  const Drive result = run(log);
  EXPECT_EQ(result.estimate.trajectory.size(), 120u);
  EXPECT_EQ(result.estimate.counters.at("unusable_scans"), 120);
  EXPECT_EQ(result.estimate.counters.at("key_scans"), 0);
  EXPECT_TRUE(result.estimate.map->empty());
}

TEST(KartoSlam, ASensorBlindAtFirstStartsWhereItFirstSees) {
  int num_scans = 0;
  const SensorLog log = changed(testing::room_log(), [&](LaserScan& scan) {
    if (num_scans++ < 10) std::fill(scan.is_valid.begin(), scan.is_valid.end(), std::uint8_t{0});
  });
  const Drive result = run(log);
  EXPECT_EQ(result.estimate.counters.at("unusable_scans"), 10);
  EXPECT_LT(result.estimate.trajectory.front().T_map_base.log().norm(), 1e-9);
  EXPECT_LT(largest_error_m(result.estimate.trajectory, *log.truth), 0.08);
}

TEST(KartoSlam, WheelsThatStartLateLeaveTheFirstScansAtTheOrigin) {
  SensorLog log = testing::room_log();
  for (int i = 0; i < 10; ++i) log.events.erase(log.events.begin() + i);  // the first wheel samples
  const Drive result = run(log);
  EXPECT_EQ(result.estimate.trajectory.size(), 120u);
  EXPECT_GT(result.estimate.counters.at("scans_without_odometry"), 0);
  EXPECT_LT(result.estimate.trajectory.front().T_map_base.log().norm(), 1e-9);
}

TEST(KartoSlam, ALogWithoutWheelsIsAnErrorThatSaysSo) {
  const auto system = make();
  Rng rng(1);
  ASSERT_TRUE(system->step(testing::scan_of(testing::room(), {}, 12, 0, rng)).has_value());
  const auto estimate = system->finish();
  ASSERT_FALSE(estimate.has_value());
  EXPECT_NE(estimate.error().to_line().find("no wheel odometry"), std::string::npos);
}

TEST(KartoParams, DefaultsAreValidAndASmearOutsideTheKernelsRangeIsNot) {
  EXPECT_TRUE(param_violations(KartoParams{}).empty());
  EXPECT_TRUE(param_violations(corrected_params()).empty());
  KartoParams params;
  params.loop_smear_m = 0.02;
  params.match_resolution_m = 0.0005;
  // The resolution is out of its range, of the smear's and of the largest grid's.
  EXPECT_EQ(param_violations(params).size(), 4u);
}

}  // namespace
}  // namespace corridor::karto
