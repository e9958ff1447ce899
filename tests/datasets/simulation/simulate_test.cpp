#include "datasets/simulation/simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "datasets/simulation/ray_casting.hpp"
#include "tests/datasets/simulation/from_log_support.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::simulation::testing {
namespace {

bool is_same(const WheelSample& a, const WheelSample& b) {
  return a.stamp == b.stamp && a.T_odom_base == b.T_odom_base && a.ticks->left == b.ticks->left &&
         a.ticks->right == b.ticks->right;
}
bool is_same(const ImuSample& a, const ImuSample& b) {
  return a.stamp == b.stamp && a.gyro_z_radps == b.gyro_z_radps &&
         a.accel_x_mps2 == b.accel_x_mps2 && a.accel_y_mps2 == b.accel_y_mps2;
}
bool is_same(const LaserScan& a, const LaserScan& b) {
  return a.stamp == b.stamp && a.ranges_m == b.ranges_m && a.is_valid == b.is_valid;
}

template <class T>
bool is_same(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const T& x, const T& y) { return is_same(x, y); });
}

bool is_same_truth(const SensorLog& a, const SensorLog& b) {
  return std::equal(a.truth->poses().begin(), a.truth->poses().end(), b.truth->poses().begin(),
                    b.truth->poses().end(), [](const TrajectoryPose& x, const TrajectoryPose& y) {
                      return x.stamp == y.stamp && x.T_map_base == y.T_map_base;
                    });
}

TEST(Simulate, EveryShippedScenarioGivesALogWithoutDefects) {
  for (const auto& path : list_scenarios()) {
    const auto scenario = read_scenario(path);
    ASSERT_TRUE(scenario) << scenario.error().to_line();
    if (scenario->name == "floor") continue;  // 548 m; the other drawn worlds stand for it
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const Simulated simulated = simulated_log(*scenario, seed);
      EXPECT_EQ(defects(simulated.log), std::vector<std::string>{}) << path << " seed " << seed;
      EXPECT_EQ(simulated.log.provenance.notes, std::vector<std::string>{}) << path;
      EXPECT_EQ(simulated.log.truth->size(), simulated.log.num_scans());
    }
  }
}

TEST(Simulate, SameSeedGivesTheSameBytes) {
  const Scenario scenario = shipped_scenario("paper-corridor-slip");
  const Simulated one = simulated_log(scenario, 4);
  const Simulated again = simulated_log(scenario, 4);
  EXPECT_TRUE(is_same(readings<LaserScan>(one.log), readings<LaserScan>(again.log)));
  EXPECT_TRUE(is_same(readings<WheelSample>(one.log), readings<WheelSample>(again.log)));
  EXPECT_TRUE(is_same(readings<ImuSample>(one.log), readings<ImuSample>(again.log)));
  EXPECT_TRUE(is_same_truth(one.log, again.log));
  EXPECT_EQ(truth_toml(one), truth_toml(again));
}

TEST(Simulate, AnotherLidarRangeLeavesDriveWheelsAndImuAsTheyWere) {
  const Simulated near = simulated_log(shipped_scenario("paper-corridor"), 2);
  const Simulated far = simulated_log(shipped_scenario("paper-corridor-12m"), 2);
  EXPECT_TRUE(is_same(readings<WheelSample>(near.log), readings<WheelSample>(far.log)));
  EXPECT_TRUE(is_same(readings<ImuSample>(near.log), readings<ImuSample>(far.log)));
  EXPECT_TRUE(is_same_truth(near.log, far.log));
  EXPECT_FALSE(is_same(readings<LaserScan>(near.log), readings<LaserScan>(far.log)));
}

TEST(Simulate, SlipsChangeTheWheelsOnly) {
  const Simulated plain = simulated_log(shipped_scenario("paper-corridor"), 2);
  const Simulated slipping = simulated_log(shipped_scenario("paper-corridor-slip"), 2);
  EXPECT_TRUE(is_same(readings<LaserScan>(plain.log), readings<LaserScan>(slipping.log)));
  EXPECT_TRUE(is_same(readings<ImuSample>(plain.log), readings<ImuSample>(slipping.log)));
  EXPECT_FALSE(is_same(readings<WheelSample>(plain.log), readings<WheelSample>(slipping.log)));
}

TEST(Simulate, WheelsTurnSixTenthsMoreDuringEachSlip) {
  const Scenario slipping = shipped_scenario("paper-corridor-slip");
  const Simulated with_slips = simulated_log(slipping, 3);
  const Simulated without = simulated_log(shipped_scenario("paper-corridor"), 3);
  const auto spinning = readings<WheelSample>(with_slips.log);
  const auto gripping = readings<WheelSample>(without.log);
  ASSERT_EQ(with_slips.truth.slips.size(), 3u);
  for (const SlipInterval& slip : with_slips.truth.slips) {
    EXPECT_NEAR(slip.end_s - slip.begin_s, 1, 1e-12);
    const auto ticks_between = [&](const std::vector<WheelSample>& samples) {
      // Whole 50 Hz samples inside the slip.
      const auto first = static_cast<std::size_t>(std::ceil(slip.begin_s * 50));
      const auto last = static_cast<std::size_t>(std::floor(slip.end_s * 50)) - 1;
      return static_cast<double>(samples[last].ticks->left - samples[first].ticks->left);
    };
    // 49 samples of about 10 mm, each with one tick of 0.1 mm: 0.1 / 400 at most.
    EXPECT_NEAR(ticks_between(spinning) / ticks_between(gripping), 1.6, 0.002);
  }
}

TEST(Simulate, SlipsNeverOverlapAndLieInsideTheDrive) {
  Scenario scenario = shipped_scenario("paper-corridor-slip");
  scenario.slip.num_slips = 12;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Simulated simulated = simulated_log(scenario, seed);
    double last_end_s = 0;
    for (const SlipInterval& slip : simulated.truth.slips) {
      EXPECT_GE(slip.begin_s, last_end_s - 1e-9);
      last_end_s = slip.end_s;
    }
    EXPECT_LE(last_end_s, to_seconds(stamp_of(simulated.log.events.back())) + 1e-9);
  }
}

TEST(Simulate, SeedsDifferInEveryDrawnThing) {
  const Scenario scenario = shipped_scenario("paper-corridor-vary");
  const SimulationTruth one = simulated_log(scenario, 1).truth;
  const SimulationTruth other = simulated_log(scenario, 2).truth;
  EXPECT_NE(one.world.corridor->a_m, other.world.corridor->a_m);
  EXPECT_NE(one.world.corridor->b_m, other.world.corridor->b_m);
  EXPECT_NE(one.world.corridor->c_m, other.world.corridor->c_m);
  EXPECT_NE(one.T_world_base_start, other.T_world_base_start);
  EXPECT_NE(one.wheels.left_scale, other.wheels.left_scale);
  EXPECT_NE(one.wheels.right_scale, other.wheels.right_scale);
  EXPECT_NE(one.imu.gyro_bias_radps, other.imu.gyro_bias_radps);
  EXPECT_NE(one.imu.accel_bias_x_mps2, other.imu.accel_bias_x_mps2);
  EXPECT_NE(one.imu.accel_bias_y_mps2, other.imu.accel_bias_y_mps2);
}

TEST(Simulate, LogStatesTheNominalCalibrationAndNotTheDrawnErrors) {
  const Simulated one = simulated_log(shipped_scenario("paper-corridor"), 1);
  EXPECT_EQ(one.log.robot.wheels.left_m_per_tick, 1e-4);
  EXPECT_EQ(one.log.robot.wheels.right_m_per_tick, 1e-4);
  EXPECT_EQ(one.log.robot.wheels.track_m, 0.35);
  EXPECT_EQ(one.log.robot.lidar.range_max_m, 4.5);
  EXPECT_NE(one.truth.wheels.left_scale, 1);
}

TEST(Simulate, EventsAtEqualStampsAreWheelsThenImuThenScan) {
  const Simulated simulated = simulated_log(shipped_scenario("paper-corridor"), 1);
  const auto rank = [](const SensorEvent& event) {
    return std::holds_alternative<WheelSample>(event) ? 0 : event.index() == 2 ? 1 : 2;
  };
  const auto& events = simulated.log.events;
  std::size_t num_triples = 0;
  for (std::size_t i = 1; i < events.size(); ++i) {
    if (stamp_of(events[i - 1]) != stamp_of(events[i])) continue;
    EXPECT_LT(rank(events[i - 1]), rank(events[i]));
    num_triples += rank(events[i]) == 2;
  }
  EXPECT_EQ(num_triples, simulated.log.num_scans());
}

TEST(Simulate, RatesAreThoseOfTheSuitesRobotAndStampsAreExact) {
  const Simulated simulated = simulated_log(shipped_scenario("paper-corridor"), 1);
  const auto scans = readings<LaserScan>(simulated.log);
  const auto wheels = readings<WheelSample>(simulated.log);
  const auto imu = readings<ImuSample>(simulated.log);
  for (std::size_t k = 0; k < 200; ++k) {
    const auto number = static_cast<std::int64_t>(k + 1);
    EXPECT_EQ(scans[k].stamp.nanoseconds, number * 100'000'000);
    EXPECT_EQ(wheels[k].stamp.nanoseconds, number * 20'000'000);
    EXPECT_EQ(imu[k].stamp.nanoseconds, number * 5'000'000);
  }
}

// Dead reckoning with the true biases taken off: what is left is white noise, which grows as a
// walk.
TEST(Simulate, ImuIntegratesToTheTrueMotion) {
  const Simulated simulated = simulated_log(shipped_scenario("paper-corridor"), 6);
  const auto imu = readings<ImuSample>(simulated.log);
  const Pose2 start = simulated.truth.T_world_base_start;
  const double step_s = 0.005;
  const double duration_s = 10;
  double heading_rad = start.theta_rad();
  double speed_mps = 0;
  Eigen::Vector2d position_m = start.translation_m();
  for (std::size_t k = 0; k < static_cast<std::size_t>(duration_s / step_s); ++k) {
    speed_mps += (imu[k].accel_x_mps2 - simulated.truth.imu.accel_bias_x_mps2) * step_s;
    heading_rad += (imu[k].gyro_z_radps - simulated.truth.imu.gyro_bias_radps) * step_s;
    position_m +=
        speed_mps * step_s * Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad));
  }
  const Pose2 truth = *simulated.log.truth->interpolate(timestamp_from_seconds(duration_s));
  // 0.01 rad/s * sqrt(2000) * 5 ms = 2.2 mrad, 0.05 m/s2 * sqrt(2000) * 5 ms = 11 mm/s; the speed's
  // walk integrates to 11 mm/s * 10 s / sqrt(3) = 65 mm, the heading's over 4.5 m to 6 mm. Times 4.
  EXPECT_NEAR(wrap_angle(heading_rad - truth.theta_rad()), 0, 4 * 0.0022);
  EXPECT_LT((position_m - truth.translation_m()).norm(), 4 * 0.065);
}

TEST(Simulate, RangeNoiseIsNewInEveryScan) {
  const Simulated simulated = simulated_log(shipped_scenario("paper-corridor"), 1);
  const RayCaster caster(simulated.world);
  const auto scans = readings<LaserScan>(simulated.log);
  const double sigma_m = simulated.truth.range_sigma_m;
  const auto error_sigmas = [&](std::size_t scan_index, std::size_t beam_index) {
    const Pose2& T_world_base = (*simulated.log.truth)[scan_index].T_map_base;
    const LaserScan& scan = scans[scan_index];
    const auto range_m =
        caster.range_m(T_world_base.translation_m(),
                       T_world_base.theta_rad() + scan.angle_rad(beam_index), scan.range_max_m);
    return (scan.ranges_m[beam_index] - *range_m) / sigma_m;
  };
  double sum = 0;
  double num_pairs = 0;
  for (std::size_t k = 0; k < 100; ++k) {
    // The 60 beams to the left, which always meet the wall 2 to 3 m away.
    for (std::size_t i = 240; i < 300; ++i, ++num_pairs) {
      sum += error_sigmas(k, i) * error_sigmas(k + 1, i);
    }
  }
  EXPECT_LT(std::abs(sum / num_pairs), 5 / std::sqrt(num_pairs));
}

TEST(Simulate, CentripetalAccelerationShowsAtTheCorner) {
  const Simulated simulated = simulated_log(shipped_scenario("paper-corridor"), 1);
  double most_mps2 = 0;
  double sum_mps2 = 0;
  for (const ImuSample& sample : readings<ImuSample>(simulated.log)) {
    sum_mps2 = 0.9 * sum_mps2 + 0.1 * sample.accel_y_mps2;
    most_mps2 = std::max(most_mps2, sum_mps2);
  }
  EXPECT_GT(most_mps2, 0.2);  // up to 0.6 m/s * 0.8 rad/s = 0.48, less while braking
  EXPECT_LT(most_mps2, 0.6);
}

TEST(Simulate, OdometryCarriesTheDrawnScaleOverTheWholePath) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Simulated simulated = simulated_log(shipped_scenario("paper-corridor"), seed);
    const double scale =
        0.5 * (simulated.truth.wheels.left_scale + simulated.truth.wheels.right_scale);
    // 25 m at 1 mm per root metre and wheel: 3.5 mm, 0.014 %; times 5.
    EXPECT_NEAR(figures_of(simulated.log).wheel_path_ratio, scale, 0.0007) << "seed " << seed;
  }
}

TEST(Simulate, TruthNamesTheArmsAsDegenerateWhereTheLidarSeesNoEnd) {
  const Simulated simulated = simulated_log(shipped_scenario("paper-corridor"), 1);
  for (const DegenerateInterval& interval : *simulated.truth.degenerate) {
    const Pose2 begin = *simulated.log.truth->interpolate(timestamp_from_seconds(interval.begin_s));
    const Pose2 end = *simulated.log.truth->interpolate(timestamp_from_seconds(interval.end_s));
    ASSERT_TRUE(interval.direction_rad);
    if (*interval.direction_rad < 0.1) {  // first arm: away from the left end and from the corner
      EXPECT_GT(begin.x_m(), 3.5);
      EXPECT_LT(end.x_m(), 16.5);
    } else {
      EXPECT_NEAR(*interval.direction_rad, std::numbers::pi / 2, 0.02);
      EXPECT_GT(begin.y_m(), 4.5);  // the range away from the lower outer wall
      EXPECT_LT(end.y_m(), 11);
    }
  }
  EXPECT_GE(simulated.truth.degenerate->size(), 2u);
}

TEST(Simulate, ARouteFromWhichNoScanSeesAWallIsRefused) {
  const ::corridor::testing::ScratchFolder folder;
  const auto beside = [&folder](const std::string& route_m) {
    const auto scenario = read_scenario(
        folder.write("beside.toml",
                     "[world]\npolygons = [{ points_m = [[0, 0], [10, 0], [10, 4], [0, 4]] }]\n"
                     "route_m = " +
                         route_m + "\n"));
    EXPECT_TRUE(scenario.has_value()) << scenario.error().to_line();
    return simulate(*scenario, 1);
  };
  const auto refused = beside("[[20, 20], [28, 20]]");
  ASSERT_FALSE(refused.has_value());
  const std::string line = refused.error().to_line();
  EXPECT_NE(line.find("beside-s1: none of "), std::string::npos) << line;
  EXPECT_NE(line.find(" scans sees a wall on the way from (2"), std::string::npos) << line;
  EXPECT_NE(line.find("at most lidar.range_max_m = 4.5 m away"), std::string::npos) << line;
  // Past the room and away from it: what is blind in part is what a LiDAR is.
  EXPECT_TRUE(beside("[[2, 7], [28, 20]]").has_value());
}

TEST(Simulate, LongRangeLidarIsNeverDegenerate) {
  EXPECT_TRUE(simulated_log(shipped_scenario("paper-corridor-12m"), 1).truth.degenerate->empty());
}

}  // namespace
}  // namespace corridor::simulation::testing
