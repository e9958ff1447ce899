#include "slam/fusion/fusion_slam.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/simulation/simulate.hpp"
#include "slam/backend/fixed_lag/fixed_lag.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/backend/isam2/isam2.hpp"
#include "slam/graph/graph_source.hpp"
#include "tests/support/synthetic_scan.hpp"

namespace corridor::fusion {
namespace {

SensorLog corridor_log(const std::string& scenario_name, std::uint64_t seed, int num_people = 0) {
  auto scenario = simulation::read_scenario(std::string(CORRIDOR_SOURCE_DIR) +
                                            "/datasets/scenarios/" + scenario_name + ".toml");
  EXPECT_TRUE(scenario.has_value());
  scenario->people.num_people = num_people;
  return simulation::simulate(*scenario, seed).value().log;
}

struct Outcome {
  SlamEstimate estimate;
  Trajectory online;
  int num_slips = 0, num_degenerate = 0;
};

Outcome run(
    const FusionParams& params, const SensorLog& log,
    std::unique_ptr<backend::BackEnd> back_end = backend::make_isam2(backend::Isam2Params{})) {
  const auto system = make_fusion("fusion", params, log.robot, std::move(back_end));
  Outcome result;
  for (const SensorEvent& event : log.events) {
    const auto report = system->step(event);
    EXPECT_TRUE(report.has_value());
    if (!report->T_map_base) continue;
    EXPECT_TRUE(result.online.append({report->stamp, *report->T_map_base, std::nullopt}));
    result.num_slips += *report->is_slip_detected ? 1 : 0;
    result.num_degenerate += *report->is_degenerate ? 1 : 0;
  }
  auto estimate = system->finish();
  EXPECT_TRUE(estimate.has_value());
  result.estimate = *estimate;
  return result;
}

double position_rmse_m(const Trajectory& estimate, const Trajectory& truth) {
  const Pose2 T_truth_map =
      *truth.interpolate(estimate.front().stamp) * estimate.front().T_map_base.inverse();
  double sum = 0;
  for (const TrajectoryPose& pose : estimate.poses()) {
    const Pose2 aligned = T_truth_map * pose.T_map_base;
    sum += (aligned.translation_m() - truth.interpolate(pose.stamp)->translation_m()).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(estimate.size()));
}

std::string bytes_of(const Trajectory& trajectory) {
  std::string bytes;
  for (const TrajectoryPose& pose : trajectory.poses()) {
    const double values[] = {pose.T_map_base.x_m(), pose.T_map_base.y_m(),
                             pose.T_map_base.theta_rad()};
    bytes.append(reinterpret_cast<const char*>(values), sizeof(values));
  }
  return bytes;
}

// The largest error of fusion in the worlds used here is 0.09 m; wheels with a gyro lose 0.2 to 0.8
// m.
constexpr double kCorridorTolerance_m = 0.15;

TEST(FusionSlam, LosesLessThanHalfOfWhatThePublishedMethodLoses) {
  double fusion_m = 0, published_m = 0;
  for (std::uint64_t seed = 904; seed < 908; ++seed) {
    const SensorLog log = corridor_log("paper-corridor", seed);
    const double error_m = position_rmse_m(run({}, log).estimate.trajectory, *log.truth);
    EXPECT_LT(error_m, kCorridorTolerance_m) << "seed " << seed;
    fusion_m += error_m;
    published_m += position_rmse_m(run(fusion_paper_params(), log).estimate.trajectory, *log.truth);
  }
  EXPECT_LT(fusion_m, 0.5 * published_m);
}

// The incremental solution and the batch one of the same graph; their matches need not be the same.
TEST(FusionSlam, ErrsNoMoreWithOneBackEndThanWithAnother) {
  const SensorLog log = corridor_log("paper-corridor", 903);
  const Outcome incremental = run({}, log);
  const Outcome batch = run({}, log, backend::make_least_squares(backend::LeastSquaresParams{}));
  const Outcome window = run({}, log, backend::make_fixed_lag({}));
  EXPECT_EQ(incremental.estimate.counters.at("failed_solves"), 0);
  EXPECT_EQ(window.estimate.counters.at("failed_solves"), 0);
  constexpr double kBackEndTolerance_m = 0.01;
  EXPECT_NEAR(position_rmse_m(incremental.estimate.trajectory, *log.truth),
              position_rmse_m(batch.estimate.trajectory, *log.truth), kBackEndTolerance_m);
  EXPECT_LT(position_rmse_m(window.estimate.trajectory, *log.truth), kCorridorTolerance_m);
}

TEST(FusionSlam, FindsTheWheelsErrorsWhereTheLidarSeesAlongTheCorridor) {
  for (std::uint64_t seed = 904; seed < 907; ++seed) {
    auto scenario = simulation::read_scenario(std::string(CORRIDOR_SOURCE_DIR) +
                                              "/datasets/scenarios/paper-corridor-12m.toml");
    ASSERT_TRUE(scenario.has_value());
    const simulation::Simulated simulated = simulation::simulate(*scenario, seed).value();
    const Outcome result = run({}, simulated.log);
    const auto& wheels = simulated.truth.wheels;
    const double track_m = simulated.log.robot.wheels.track_m;
    // Measured = true path times the wheel's scale.
    const double scale = 2 / (wheels.left_scale + wheels.right_scale) - 1;
    const double unbalance_radpm = (wheels.left_scale - wheels.right_scale) / track_m;
    EXPECT_NEAR(result.estimate.counters.at("wheel_scale"), scale, 1e-3) << seed;
    EXPECT_NEAR(result.estimate.counters.at("wheel_unbalance_radpm"), unbalance_radpm, 5e-3)
        << seed;
    EXPECT_NEAR(result.estimate.counters.at("axle_x_m"), 0, 5e-3) << seed;
    EXPECT_NEAR(result.estimate.counters.at("wheel_delay_s"), 0, 5e-3) << seed;
  }
}

// A window that forgets what no factor names: the wheels' calibration, while nobody uses wheels.
TEST(FusionSlam, AWindowHoldsWithoutWheels) {
  FusionParams params;
  params.use_wheels = false;
  backend::FixedLagParams window;
  window.lag = 30;
  const Outcome result =
      run(params, corridor_log("paper-corridor-12m", 904), backend::make_fixed_lag(window));
  EXPECT_EQ(result.estimate.counters.at("failed_solves"), 0);
}

// Wheels that fall silent for longer than the window is, and come back.
TEST(FusionSlam, AWindowHoldsWhereTheWheelsComeBack) {
  SensorLog log = corridor_log("paper-corridor-12m", 904);
  const Timestamp begin = log.events.empty() ? Timestamp{} : stamp_of(log.events.front());
  std::erase_if(log.events, [&](const SensorEvent& event) {
    const double t = seconds_between(begin, stamp_of(event));
    return std::holds_alternative<WheelSample>(event) && t > 15 && t < 45;
  });
  backend::FixedLagParams window;
  window.lag = 30;
  const Outcome result = run({}, log, backend::make_fixed_lag(window));
  EXPECT_EQ(result.estimate.counters.at("failed_solves"), 0);
}

TEST(FusionSlam, KeepsTheCorridorsLengthWhereScanMatchingCannotSeeIt) {
  const SensorLog log = corridor_log("paper-corridor", 901);
  const Outcome result = run({}, log);
  EXPECT_EQ(result.estimate.trajectory.size(), log.num_scans());
  EXPECT_EQ(result.online.size(), log.num_scans());
  EXPECT_LT(position_rmse_m(result.estimate.trajectory, *log.truth), kCorridorTolerance_m);
  EXPECT_LT(position_rmse_m(result.online, *log.truth), kCorridorTolerance_m);
  EXPECT_GT(result.num_degenerate, 100);
  ASSERT_TRUE(result.estimate.map.has_value());
  EXPECT_FALSE(result.estimate.map->empty());
}

// Every sensor falls silent for 3 s, now the one, now the other.
TEST(FusionSlam, DrivesOnWhileASensorIsSilentForSeconds) {
  for (std::size_t silent = 0; silent < std::variant_size_v<SensorEvent>; ++silent) {
    SensorLog log = corridor_log("paper-corridor", 903);
    const Timestamp begin = stamp_of(log.events.front());
    std::erase_if(log.events, [&](const SensorEvent& event) {
      return event.index() == silent && std::fmod(seconds_between(begin, stamp_of(event)), 12) > 9;
    });
    const Outcome result = run({}, log);
    EXPECT_EQ(result.estimate.trajectory.size(), log.num_scans()) << silent;
    EXPECT_EQ(result.estimate.counters.at("failed_solves"), 0) << silent;
    EXPECT_LT(position_rmse_m(result.estimate.trajectory, *log.truth), kCorridorTolerance_m)
        << silent;
  }
}

// Without the vote of wheels and IMU these worlds end 3 to 35 m off.
TEST(FusionSlam, PeopleWhoWalkInTheCorridorDoNotDragTheRobot) {
  for (const int num_people : {1, 6}) {
    for (const std::uint64_t seed : {5, 7}) {
      const SensorLog log = corridor_log("paper-corridor", seed, num_people);
      const Outcome result = run({}, log);
      EXPECT_LT(position_rmse_m(result.estimate.trajectory, *log.truth), kCorridorTolerance_m)
          << num_people << " people, seed " << seed;
      EXPECT_GT(result.estimate.counters.at("outvoted_directions"), 5);
    }
  }
}

TEST(FusionSlam, InAnEmptyCorridorTheLidarIsNotOutvoted) {
  const Outcome result = run({}, corridor_log("paper-corridor", 5));
  EXPECT_EQ(result.estimate.counters.at("outvoted_directions"), 0);
}

TEST(FusionSlam, NoticesSlipAndDrivesOnWithTheImu) {
  const SensorLog log = corridor_log("paper-corridor-slip", 902);
  const Outcome result = run({}, log);
  EXPECT_GT(result.num_slips, 5);
  EXPECT_LT(position_rmse_m(result.estimate.trajectory, *log.truth), kCorridorTolerance_m);
}

TEST(FusionSlam, RunsThePublishedMethod) {
  const SensorLog log = corridor_log("paper-corridor", 901);
  const Outcome result = run(fusion_paper_params(), log);
  EXPECT_EQ(result.estimate.trajectory.size(), log.num_scans());
  EXPECT_LT(position_rmse_m(result.estimate.trajectory, *log.truth), 1.0);
}

TEST(FusionSlam, GivesTheSameBytesTwice) {
  const SensorLog log = corridor_log("paper-corridor", 903);
  EXPECT_EQ(bytes_of(run({}, log).estimate.trajectory), bytes_of(run({}, log).estimate.trajectory));
}

// The log without the readings of one sensor between two times after its begin.
template <class Reading>
SensorLog without(const SensorLog& log, double from_s, double to_s) {
  SensorLog result = log;
  const Timestamp begin = stamp_of(log.events.front());
  std::erase_if(result.events, [&](const SensorEvent& event) {
    const double time_s = seconds_between(begin, stamp_of(event));
    return std::holds_alternative<Reading>(event) && time_s >= from_s && time_s < to_s;
  });
  return result;
}

TEST(FusionSlam, UsesAnImuThatStartsAfterTheFirstScan) {
  const SensorLog log = corridor_log("paper-corridor-slip", 902);
  const Outcome late = run({}, without<ImuSample>(log, 0, 3));
  const Outcome never = run({}, without<ImuSample>(log, 0, 1e6));
  EXPECT_EQ(late.estimate.counters.at("imu_used"), 1);
  EXPECT_EQ(never.estimate.counters.at("imu_used"), 0);
  EXPECT_GT(late.num_slips, 5);
  const double late_m = position_rmse_m(late.estimate.trajectory, *log.truth);
  EXPECT_LT(late_m, kCorridorTolerance_m);
  EXPECT_LT(late_m, position_rmse_m(never.estimate.trajectory, *log.truth));
}

TEST(FusionSlam, DrivesOnByTheImuWhereTheWheelsFallSilentInACorridor) {
  const SensorLog log = corridor_log("paper-corridor", 904);
  const SensorLog silent = without<WheelSample>(log, 20, 22);
  ASSERT_LT(silent.events.size(), log.events.size());
  const Outcome result = run({}, silent);
  EXPECT_LT(position_rmse_m(result.estimate.trajectory, *log.truth), kCorridorTolerance_m);
  EXPECT_LT(position_rmse_m(result.online, *log.truth), kCorridorTolerance_m);
}

TEST(FusionSlam, AnImuThatStopsIsNoWorseThanNone) {
  const SensorLog log = corridor_log("paper-corridor", 906);
  for (const FusionParams& params : {FusionParams{}, fusion_paper_params()}) {
    const double without_imu_m = position_rmse_m(
        run(params, without<ImuSample>(log, 0, 1e6)).estimate.trajectory, *log.truth);
    // On the straight, in the turn and after it.
    for (const double stop_s : {10.0, 36.0, 38.0, 40.0}) {
      const Outcome result = run(params, without<ImuSample>(log, stop_s, 1e6));
      EXPECT_EQ(result.estimate.counters.at("failed_solves"), 0);
      EXPECT_LT(position_rmse_m(result.estimate.trajectory, *log.truth), without_imu_m)
          << "stop at " << stop_s << " s";
    }
  }
}

TEST(FusionSlam, DrivesThroughAGapOfTheImuInATurn) {
  const SensorLog log = corridor_log("paper-corridor", 906);
  const Outcome result = run({}, without<ImuSample>(log, 38, 41));
  EXPECT_LT(position_rmse_m(result.estimate.trajectory, *log.truth), kCorridorTolerance_m);
}

SensorLog room_log(bool has_wheels, bool has_imu, int num_scans) {
  SensorLog log;
  Rng rng(12);
  Trajectory truth;
  for (int i = 0; i < num_scans; ++i) {
    const Timestamp stamp = timestamp_from_seconds(0.1 * i);
    const Pose2 pose(-1 + 0.03 * i, 0.3 * std::sin(0.1 * i), 0.02 * i);
    if (has_wheels) log.events.push_back(WheelSample{stamp, pose, std::nullopt});
    if (has_imu) log.events.push_back(ImuSample{stamp, 0.2, 0, 0});
    log.events.push_back(testing::scan_of(testing::room(), pose, 30, 0.01, rng, stamp));
    EXPECT_TRUE(truth.append({stamp, pose, std::nullopt}));
  }
  log.truth = truth;
  return log;
}

TEST(FusionSlam, WorksWithALidarAlone) {
  const SensorLog log = room_log(false, false, 60);
  EXPECT_LT(position_rmse_m(run({}, log).estimate.trajectory, *log.truth), 0.05);
}

TEST(FusionSlam, WorksWithLidarAndWheels) {
  const SensorLog log = room_log(true, false, 60);
  EXPECT_LT(position_rmse_m(run({}, log).estimate.trajectory, *log.truth), 0.03);
}

TEST(FusionSlam, SurvivesScansWithoutReturns) {
  SensorLog log = room_log(true, false, 40);
  for (std::size_t i = 0; i < log.events.size(); ++i) {
    auto* scan = std::get_if<LaserScan>(&log.events[i]);
    if (scan != nullptr && (i / 2) % 3 == 0) scan->is_valid.assign(scan->num_beams(), 0);
  }
  const Outcome result = run({}, log);
  EXPECT_EQ(result.estimate.trajectory.size(), 40u);
  EXPECT_LT(position_rmse_m(result.estimate.trajectory, *log.truth), 0.05);
}

TEST(FusionSlam, OneScanGivesOnePoseAtTheOrigin) {
  const Outcome result = run({}, room_log(true, true, 1));
  ASSERT_EQ(result.estimate.trajectory.size(), 1u);
  EXPECT_LT(result.estimate.trajectory.front().T_map_base.log().norm(), 1e-9);
}

TEST(FusionSlam, WithoutSubmapsThereIsNothingToRefine) {
  FusionParams params;
  params.use_submaps = false;
  const Outcome result = run(params, room_log(true, true, 40));
  EXPECT_EQ(result.estimate.trajectory.size(), 40u);
}

TEST(FusionSlam, NoEventsGiveAnEmptyTrajectory) {
  const Outcome result = run({}, SensorLog{});
  EXPECT_TRUE(result.estimate.trajectory.empty());
  EXPECT_FALSE(result.estimate.map.has_value());
}

TEST(FusionSlam, AStandingRobotStays) {
  SensorLog log;
  Rng rng(13);
  for (int i = 0; i < 100; ++i) {
    const Timestamp stamp = timestamp_from_seconds(0.1 * i);
    log.events.push_back(WheelSample{stamp, {}, std::nullopt});
    log.events.push_back(
        ImuSample{stamp, rng.normal(0.002, 0.01), rng.normal(0.02, 0.05), rng.normal(0, 0.05)});
    log.events.push_back(testing::scan_of(testing::room(), {}, 30, 0.01, rng, stamp));
  }
  log.robot.imu.rate_hz = 10;
  const Outcome result = run({}, log);
  for (const TrajectoryPose& pose : result.estimate.trajectory.poses()) {
    EXPECT_LT(pose.T_map_base.translation_m().norm(), 0.02);
  }
}

TEST(FusionSlam, HandsOutTheGraphItSolved) {
  const SensorLog log = room_log(true, false, 30);
  const auto system = make_fusion("fusion", {}, log.robot,
                                  backend::make_least_squares(backend::LeastSquaresParams{}));
  for (const SensorEvent& event : log.events) ASSERT_TRUE(system->step(event).has_value());
  const auto estimate = system->finish();
  ASSERT_TRUE(estimate.has_value());
  const auto* source = dynamic_cast<const graph::GraphSource*>(system.get());
  ASSERT_NE(source, nullptr);
  EXPECT_EQ(static_cast<double>(source->solved_graph().num_factors()),
            estimate->counters.at("factors"));
  EXPECT_NEAR(source->solved_graph().chi2(source->solved_values()), estimate->counters.at("chi2"),
              1e-6);
}

}  // namespace
}  // namespace corridor::fusion
