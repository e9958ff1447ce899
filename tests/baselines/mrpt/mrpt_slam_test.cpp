#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>

#include "baselines/mrpt/mrpt_icp.hpp"
#include "baselines/mrpt/mrpt_rbpf.hpp"
#include "tests/support/room_drive.hpp"

namespace corridor::mrpt {
namespace {

struct SlamRun {
  std::vector<Pose2> online;
  SlamEstimate estimate;
};

using Factory = std::function<std::unique_ptr<SlamSystem>(const RobotModel&)>;

std::unique_ptr<SlamSystem> icp(const RobotModel& robot) { return make_mrpt_icp({}, robot); }
std::unique_ptr<SlamSystem> rbpf(const RobotModel& robot) {
  return make_mrpt_rbpf({}, robot, Rng(1));
}

std::unique_ptr<SlamSystem> dense_rbpf(const RobotModel& robot) {
  return make_mrpt_rbpf(dense_rbpf_params(), robot, Rng(1));
}

SlamRun run(const SensorLog& log, const Factory& make) {
  const auto slam = make(log.robot);
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

// Largest distance between the estimate and the truth [m].
double worst_error_m(const SlamRun& result, const SensorLog& log) {
  double worst_m = 0;
  for (std::size_t i = 0; i < log.truth->size(); ++i) {
    worst_m = std::max(worst_m, (result.estimate.trajectory[i].T_map_base.translation_m() -
                                 (*log.truth)[i].T_map_base.translation_m())
                                    .norm());
  }
  return worst_m;
}

// Share of the end points of all scans, at their true poses, whose cell or a neighbour is occupied.
double share_of_walls_on_map(const SlamRun& result, const SensorLog& log) {
  const GridMap& map = *result.estimate.map;
  std::size_t scan_index = 0;
  int num_points = 0;
  int num_found = 0;
  for (const SensorEvent& event : log.events) {
    const auto* scan = std::get_if<LaserScan>(&event);
    if (scan == nullptr) continue;
    const Pose2 T_map_base = (*log.truth)[scan_index++].T_map_base;
    for (std::size_t i = 0; i < scan->num_beams(); i += 10) {
      if (scan->is_valid[i] == 0) continue;
      const Eigen::Vector2i cell = map.cell_of(T_map_base * scan->point_base_m(i));
      bool is_found = false;
      for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) {
          is_found |= map.contains(cell.x() + dx, cell.y() + dy) &&
                      map.at(cell.x() + dx, cell.y() + dy).log_odds > 0;
        }
      }
      ++num_points;
      num_found += is_found ? 1 : 0;
    }
  }
  return static_cast<double>(num_found) / num_points;
}

void expect_same(const SlamRun& a, const SlamRun& b) {
  EXPECT_TRUE(a.online == b.online);
  ASSERT_EQ(a.estimate.trajectory.size(), b.estimate.trajectory.size());
  for (std::size_t i = 0; i < a.estimate.trajectory.size(); ++i) {
    EXPECT_EQ(a.estimate.trajectory[i].T_map_base, b.estimate.trajectory[i].T_map_base) << i;
  }
  EXPECT_EQ(a.estimate.map, b.estimate.map);
}

TEST(MrptIcp, TracksARoomThatTheOdometryMisjudgesByThreePercent) {
  const SensorLog log = testing::room_log();
  const SlamRun result = run(log, icp);
  ASSERT_EQ(result.estimate.trajectory.size(), log.truth->size());
  // Odometry runs on uncorrected for up to 0.2 m; pairs are accepted up to 0.05 m.
  EXPECT_LT(worst_error_m(result, log), 0.15);
  EXPECT_GT(share_of_walls_on_map(result, log), 0.8);
  EXPECT_EQ(result.online.back(), result.estimate.trajectory.back().T_map_base);
}

TEST(MrptRbpf, WithOptimalSamplingTracksARoomThatTheOdometryMisjudgesByThreePercent) {
  const SensorLog log = testing::room_log();
  const SlamRun result = run(log, rbpf);
  ASSERT_EQ(result.estimate.trajectory.size(), log.truth->size());
  // Cells of 0.07 m and a likelihood raised to 0.01: the particles scatter by decimetres.
  EXPECT_LT(worst_error_m(result, log), 0.5);
  ASSERT_TRUE(result.estimate.map.has_value());
  EXPECT_DOUBLE_EQ(result.estimate.map->resolution_m(), static_cast<double>(0.07F));
  EXPECT_GT(result.estimate.counters.at("key_scans"), 5);
}

TEST(MrptRbpf, WithIcpProposalsTracksThatRoomAsWellAsIcpAlone) {
  const SensorLog log = testing::room_log();
  const SlamRun result = run(log, dense_rbpf);
  ASSERT_EQ(result.estimate.trajectory.size(), log.truth->size());
  EXPECT_LT(worst_error_m(result, log), 0.15);
  EXPECT_GT(share_of_walls_on_map(result, log), 0.8);
}

TEST(MrptRbpf, AsShippedForIntelTracksThatRoomToo) {
  const SensorLog log = testing::room_log();
  const SlamRun result = run(log, [](const RobotModel& robot) {
    return make_mrpt_rbpf(icp_rbpf_params(), robot, Rng(1));
  });
  ASSERT_EQ(result.estimate.trajectory.size(), log.truth->size());
  EXPECT_LT(worst_error_m(result, log), 0.3);
}

TEST(MrptIcp, GivesTheSameBytesTwice) {
  const SensorLog log = testing::room_log({.num_scans = 40});
  expect_same(run(log, icp), run(log, icp));
}

TEST(MrptRbpf, GivesTheSameBytesForTheSameSeedAndOthersForAnother) {
  const SensorLog log = testing::room_log({.num_scans = 40});
  const SlamRun first = run(log, rbpf);
  expect_same(first, run(log, rbpf));
  const SlamRun dense = run(log, dense_rbpf);
  expect_same(dense, run(log, dense_rbpf));
  const SlamRun other =
      run(log, [](const RobotModel& robot) { return make_mrpt_rbpf({}, robot, Rng(2)); });
  EXPECT_FALSE(first.online == other.online);
  const SlamRun other_dense = run(log, [](const RobotModel& robot) {
    return make_mrpt_rbpf(dense_rbpf_params(), robot, Rng(2));
  });
  EXPECT_FALSE(dense.online == other_dense.online);
}

TEST(MrptRbpf, IsNotDisturbedByAnotherFilterInTheSameProcess) {
  const SensorLog log = testing::room_log({.num_scans = 40});
  const auto one = make_mrpt_rbpf({}, log.robot, Rng(1));
  const auto two = make_mrpt_rbpf({}, log.robot, Rng(2));
  SlamRun interleaved;
  for (const SensorEvent& event : log.events) {
    const Result<StepReport> report = one->step(event);
    ASSERT_TRUE(report.has_value());
    ASSERT_TRUE(two->step(event).has_value());
    if (report->T_map_base) interleaved.online.push_back(*report->T_map_base);
  }
  EXPECT_TRUE(interleaved.online == run(log, rbpf).online);
}

TEST(MrptSlam, StartsAtTheFirstScanWhateverTheOdometrySaidBefore) {
  SensorLog log = testing::room_log({.num_scans = 60, .odometry_scale = 1.0});
  const Pose2 shift(30, -20, 2);
  for (SensorEvent& event : log.events) {
    if (auto* wheel = std::get_if<WheelSample>(&event)) {
      wheel->T_odom_base = shift * wheel->T_odom_base;
    }
  }
  const WheelSample early{add_seconds(stamp_of(log.events.front()), -0.05),
                          shift * Pose2(-0.5, 0, 0.2), std::nullopt};
  log.events.insert(log.events.begin(), early);
  EXPECT_LT(run(log, icp).online.front().minus(Pose2()).norm(), 1e-9);
  EXPECT_LT(worst_error_m(run(log, icp), log), 0.15);
  EXPECT_LT(run(log, rbpf).online.front().minus(Pose2()).norm(), 1e-9);
}

TEST(MrptSlam, SurvivesScansWithoutValidBeamsAndARobotThatStands) {
  SensorLog log = testing::room_log({.num_scans = 20});
  for (SensorEvent& event : log.events) {
    if (auto* wheel = std::get_if<WheelSample>(&event)) wheel->T_odom_base = Pose2();
    if (auto* scan = std::get_if<LaserScan>(&event)) {
      std::fill(scan->is_valid.begin(), scan->is_valid.end(), std::uint8_t{0});
    }
  }
  for (const Factory& make : {Factory(icp), Factory(rbpf), Factory(dense_rbpf)}) {
    for (const Pose2& pose : run(log, make).online) EXPECT_TRUE(pose.is_finite());
  }
}

TEST(MrptSlam, OfNoEventsHasAnEmptyEstimate) {
  for (const Factory& make : {Factory(icp), Factory(rbpf), Factory(dense_rbpf)}) {
    const SlamRun result = run(SensorLog{}, make);
    EXPECT_TRUE(result.estimate.trajectory.empty());
    EXPECT_TRUE(result.estimate.map->empty());
  }
}

}  // namespace
}  // namespace corridor::mrpt
