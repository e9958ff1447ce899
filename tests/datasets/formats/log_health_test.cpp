// A log with one fault each: what the report says of it, and where.
#include "datasets/formats/log_health.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "datasets/formats/log_io.hpp"
#include "tests/datasets/formats/formats_support.hpp"
#include "tests/datasets/formats/health_support.hpp"
#include "tests/support/room_drive.hpp"

namespace corridor::formats {
namespace {

using test::all_lines;
using test::change_each;
using test::expect_suspicion;
using test::ScratchFolder;
using test::write_text;

constexpr double kDegreesPerRadian = 57.29577951308232;

// A drive round a room: scans and wheels at 10 Hz, and an IMU at 100 Hz whose gyro is the wheels'.
SensorLog sound_log() {
  SensorLog drive = testing::room_log({.num_scans = 60, .odometry_scale = 1.0});
  SensorLog log;
  log.robot = drive.robot;
  log.robot.imu.rate_hz = 100;
  log.truth = drive.truth;
  const WheelSample* last = nullptr;
  for (SensorEvent& event : drive.events) {
    if (const auto* sample = std::get_if<WheelSample>(&event)) {
      for (int i = 1; last != nullptr && i <= 10; ++i) {
        const double step_s = seconds_between(last->stamp, sample->stamp);
        const double turn_rad = last->T_odom_base.between(sample->T_odom_base).theta_rad();
        log.events.emplace_back(
            ImuSample{add_seconds(last->stamp, 0.1 * i * step_s), turn_rad / step_s, 0.1, -0.1});
      }
      last = sample;
    }
  }
  for (SensorEvent& event : drive.events) log.events.push_back(event);
  std::stable_sort(log.events.begin(), log.events.end(),
                   [](const auto& a, const auto& b) { return stamp_of(a) < stamp_of(b); });
  return log;
}

template <class T>
std::size_t index_of_nth(const SensorLog& log, int n) {
  for (std::size_t i = 0; i < log.events.size(); ++i) {
    if (std::holds_alternative<T>(log.events[i]) && n-- == 0) return i;
  }
  return log.events.size();
}

template <class T>
T& nth(SensorLog& log, int n) {
  return std::get<T>(log.events[index_of_nth<T>(log, n)]);
}

TEST(LogHealth, OfASoundLogFindsNothingWrong) {
  const SensorLog log = sound_log();
  const LogHealth health = examine(log);
  EXPECT_TRUE(health.defects.empty()) << all_lines(health.defects);
  EXPECT_TRUE(health.suspicions.empty()) << all_lines(health.suspicions);
  EXPECT_EQ(health.lidar_stamps.num_readings, 60U);
  EXPECT_EQ(health.wheel_stamps.num_readings, 60U);
  EXPECT_EQ(health.imu_stamps.num_readings, 590U);
  EXPECT_NEAR(health.lidar_stamps.median_rate_hz(), 10, 1e-6);
  EXPECT_NEAR(health.imu_stamps.median_rate_hz(), 100, 1e-3);
  EXPECT_NEAR(health.lidar_stamps.longest_gap_s, 0.1, 1e-9);
  EXPECT_EQ(health.lidar_stamps.num_gaps, 0U);
  EXPECT_EQ(health.lidar->min_beams, 360U);
  EXPECT_NEAR(health.lidar->field_of_view_rad * kDegreesPerRadian, 359, 1e-6);
  EXPECT_EQ(health.lidar->range_limit_m, 12);
  EXPECT_GT(health.lidar->median_range_m, health.lidar->min_range_m);
  EXPECT_NEAR(health.truth->path_m, health.wheels->path_m, 1e-6);
  EXPECT_EQ(health.truth->scans_with_pose_ratio, 1);
  EXPECT_NEAR(*health.imu->gyro_turn_rad, *health.imu->wheel_turn_rad, 0.2);
}

TEST(LogHealth, CountsPathAndTurnByHand) {
  SensorLog log;
  log.events = {WheelSample{{0}, Pose2(), WheelTicks{}},
                WheelSample{{1'000'000'000}, Pose2(3, 4, 0.5), WheelTicks{}},
                WheelSample{{3'000'000'000}, Pose2(3, 4, -0.5), WheelTicks{}}};
  const LogHealth health = examine(log);
  EXPECT_DOUBLE_EQ(health.wheels->path_m, 5);
  EXPECT_DOUBLE_EQ(health.wheels->turn_rad, 1.5);
  EXPECT_DOUBLE_EQ(*health.wheels->max_speed_mps, 5);
  EXPECT_EQ(health.wheels->max_speed_at, "event 1");
  EXPECT_DOUBLE_EQ(*health.wheels->max_yaw_rate_radps, 0.5);
  EXPECT_TRUE(health.wheels->has_ticks);
  EXPECT_FALSE(health.lidar.has_value());
  EXPECT_FALSE(health.imu.has_value());
}

TEST(LogHealth, CountsBeamsWithoutReturn) {
  SensorLog log = test::small_log();
  const LogHealth health = examine(log);
  EXPECT_DOUBLE_EQ(health.lidar->invalid_ratio, 0.125);
  EXPECT_DOUBLE_EQ(health.lidar->field_of_view_rad, 1.75);
  EXPECT_FLOAT_EQ(static_cast<float>(health.lidar->max_range_m), 2.25F);
  bool is_first = true;
  change_each<LaserScan>(log, [&is_first](LaserScan& scan) {
    scan.is_valid.assign(8, 0);
    scan.is_valid[0] = is_first ? 1 : 0;
    is_first = false;
  });
  expect_suspicion(log, "96.9 % of the beams are without return");
}

TEST(LogHealth, PlacesRepeatedStampsStepsBackAndGaps) {
  SensorLog log = sound_log();
  nth<LaserScan>(log, 5).stamp = nth<LaserScan>(log, 4).stamp;
  nth<LaserScan>(log, 9).stamp = add_seconds(nth<LaserScan>(log, 8).stamp, -0.05);
  const LogHealth health = examine(log);
  EXPECT_EQ(health.lidar_stamps.num_repeats, 1U);
  EXPECT_EQ(health.lidar_stamps.num_back, 1U);
  const std::string first = "event " + std::to_string(index_of_nth<LaserScan>(log, 5));
  EXPECT_EQ(health.lidar_stamps.first_bad_at, first);
  EXPECT_FALSE(health.defects.empty());
  EXPECT_NE(all_lines(health.defects).find(first + ":"), std::string::npos);

  SensorLog gap = sound_log();
  std::erase_if(gap.events, [](const SensorEvent& event) {
    const double stamp_s = to_seconds(stamp_of(event));
    return std::holds_alternative<LaserScan>(event) && stamp_s > 1.05 && stamp_s < 2.05;
  });
  const LogHealth found = examine(gap);
  EXPECT_NEAR(found.lidar_stamps.longest_gap_s, 1.1, 1e-9);
  EXPECT_EQ(found.lidar_stamps.num_gaps, 1U);
  EXPECT_EQ(found.lidar_stamps.longest_gap_at,
            "event " + std::to_string(index_of_nth<LaserScan>(gap, 11)));
}

TEST(LogHealth, SuspectsARobotOutOfAllProportion) {
  SensorLog log = sound_log();
  log.robot.wheels.track_m = 350;
  expect_suspicion(log, "robot model: a track of 350 m");
  log.robot.wheels.track_m = 0.00035;
  expect_suspicion(log, "robot model: a track of 0.00035 m");
  log.robot.lidar.T_base_lidar = Pose2(145, 0, 0);
  expect_suspicion(log, "robot model: a LiDAR 145 m away from the base");
}

TEST(LogHealth, SuspectsMillisecondsForSeconds) {
  SensorLog log = sound_log();
  change_each<LaserScan>(log, [](LaserScan& scan) { scan.stamp.nanoseconds *= 1000; });
  change_each<WheelSample>(log, [](WheelSample& sample) { sample.stamp.nanoseconds *= 1000; });
  change_each<ImuSample>(log, [](ImuSample& sample) { sample.stamp.nanoseconds *= 1000; });
  expect_suspicion(log, "LiDAR: 100.000 s between readings; milliseconds for seconds?");
  change_each<LaserScan>(log, [](LaserScan& scan) { scan.stamp.nanoseconds *= 1000; });
  expect_suspicion(log, "LiDAR: 100000.000 s between readings; microseconds for seconds?");
  SensorLog short_log = sound_log();
  change_each<LaserScan>(short_log, [](LaserScan& scan) { scan.stamp.nanoseconds /= 1000; });
  expect_suspicion(short_log, "seconds for milliseconds?");
}

TEST(LogHealth, SuspectsDegreesForRadians) {
  SensorLog gyro = sound_log();
  change_each<ImuSample>(gyro, [](ImuSample& s) { s.gyro_z_radps *= kDegreesPerRadian; });
  expect_suspicion(gyro, "its rates in degrees per second?");
  SensorLog scans = sound_log();
  change_each<LaserScan>(scans, [](LaserScan& s) { s.angle_increment_rad *= kDegreesPerRadian; });
  expect_suspicion(scans, "field of view of 359.0 rad; degrees for radians?");
  SensorLog wheels = sound_log();
  change_each<WheelSample>(wheels, [](WheelSample& s) {
    s.T_odom_base = Pose2(s.T_odom_base.x_m(), s.T_odom_base.y_m(),
                          s.T_odom_base.theta_rad() * kDegreesPerRadian);
  });
  expect_suspicion(wheels, "rad/s (event");
}

TEST(LogHealth, SuspectsCentimetresAndMillimetresForMetres) {
  SensorLog scans = sound_log();
  change_each<LaserScan>(scans, [](LaserScan& scan) {
    scan.range_max_m *= 100;
    for (float& range_m : scan.ranges_m) range_m *= 100;
  });
  expect_suspicion(scans, "centimetres or millimetres for metres?");
  SensorLog wheels = sound_log();
  change_each<WheelSample>(wheels, [](WheelSample& s) {
    s.T_odom_base =
        Pose2(s.T_odom_base.x_m() * 1000, s.T_odom_base.y_m() * 1000, s.T_odom_base.theta_rad());
  });
  expect_suspicion(wheels, "wheels: ");
  EXPECT_GT(examine(wheels).wheels->num_jumps, 50U);
  SensorLog twice = sound_log();
  change_each<LaserScan>(twice, [](LaserScan& scan) {
    for (float& range_m : scan.ranges_m) range_m /= 1000;
  });
  expect_suspicion(twice, "metres taken for centimetres or millimetres?");
}

TEST(LogHealth, SuspectsUnitsWhereNoBeamHasAReturn) {
  SensorLog millimetres = sound_log();
  change_each<LaserScan>(millimetres, [](LaserScan& scan) {
    std::fill(scan.is_valid.begin(), scan.is_valid.end(), 0);
    for (float& range_m : scan.ranges_m) range_m *= 1000;
  });
  expect_suspicion(millimetres, "no beam of any scan has a return");
}

TEST(LogHealth, SuspectsGravityInAHorizontalAxis) {
  SensorLog log = sound_log();
  change_each<ImuSample>(log, [](ImuSample& sample) { sample.accel_y_mps2 += 9.81; });
  expect_suspicion(log, "IMU: y reads 9.71 m/s2 at the median; gravity in a horizontal axis?");
}

TEST(LogHealth, SuspectsAGyroThatTurnsAgainstTheWheels) {
  SensorLog log = sound_log();
  change_each<ImuSample>(log, [](ImuSample& sample) { sample.gyro_z_radps *= -1; });
  expect_suspicion(log, "an axis that points down");
  change_each<ImuSample>(log, [](ImuSample& sample) { sample.gyro_z_radps *= -2; });
  expect_suspicion(log, "a scale, the track, or slip?");
}

TEST(LogHealth, TakesTheGyrosBiasFromWhereTheWheelsRest) {
  SensorLog log;
  Pose2 T_odom_base;
  for (int i = 0; i < 400; ++i) {
    const Timestamp stamp{50'000'000LL * i};
    const double rate_radps = i > 200 ? 0.5 : 0.0;
    if (i > 200) T_odom_base = T_odom_base.plus({0.01, 0, 0.025});
    log.events.emplace_back(ImuSample{stamp, rate_radps + 0.3, 0, 0});
    log.events.emplace_back(WheelSample{stamp, T_odom_base, std::nullopt});
  }
  const LogHealth health = examine(log);
  EXPECT_NEAR(*health.imu->gyro_turn_rad / *health.imu->wheel_turn_rad, 1, 1e-6);
}

TEST(LogHealth, SuspectsATruthOfAnotherClock) {
  SensorLog log = sound_log();
  Trajectory truth;
  for (TrajectoryPose pose : log.truth->poses()) {
    pose.stamp = add_seconds(pose.stamp, 1000);
    EXPECT_TRUE(truth.append(pose));
  }
  log.truth = truth;
  expect_suspicion(log, "no scan has a true pose within 10 ms");
}

TEST(LogHealth, SuspectsAClockThatJumps) {
  SensorLog log = sound_log();
  const auto num_events = log.events.size();
  for (std::size_t i = num_events / 2; i < num_events; ++i) {
    std::visit([](auto& reading) { reading.stamp = add_seconds(reading.stamp, 5); }, log.events[i]);
  }
  EXPECT_TRUE(examine(log).defects.empty());
  for (const char* sensor : {"LiDAR", "wheels", "IMU"}) {
    expect_suspicion(log, std::string(sensor) + ": no reading for 5.");
  }
  expect_suspicion(log, "a clock that jumps, or a break in the recording?");
}

// Codes for "no return" that the stated limit lets pass.
TEST(LogHealth, SuspectsOneFarRangeThatManyBeamsShare) {
  SensorLog log = sound_log();
  change_each<LaserScan>(log, [](LaserScan& scan) {
    scan.range_max_m = 81;
    scan.ranges_m[0] = scan.ranges_m[scan.num_beams() / 2] = 50;
    scan.is_valid[0] = scan.is_valid[scan.num_beams() / 2] = 1;
  });
  expect_suspicion(log, "at exactly 50.000 m; a code for no return, below the limit of 81.000 m?");
}

TEST(LogHealth, SuspectsWheelsFasterThanRobotsIndoors) {
  SensorLog log = sound_log();
  change_each<WheelSample>(log, [](WheelSample& sample) {
    const Pose2& pose = sample.T_odom_base;
    sample.T_odom_base = Pose2(4 * pose.x_m(), 4 * pose.y_m(), pose.theta_rad());
  });
  EXPECT_TRUE(examine(log).defects.empty()) << all_lines(examine(log).defects);
  expect_suspicion(log, "centimetres or millimetres for metres, a jump");
}

TEST(LogHealth, OfDegenerateLogsIsAReportToo) {
  EXPECT_FALSE(examine(SensorLog{}).defects.empty());
  SensorLog one;
  one.events = {LaserScan{}};
  EXPECT_EQ(examine(one).lidar->max_beams, 0U);
  SensorLog broken = sound_log();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  nth<LaserScan>(broken, 3).ranges_m[7] = kNan;
  nth<ImuSample>(broken, 3).gyro_z_radps = std::nan("");
  const LogHealth health = examine(broken);
  EXPECT_EQ(health.defects.size(), 2U) << all_lines(health.defects);
  EXPECT_TRUE(std::isfinite(health.lidar->max_range_m));
  EXPECT_TRUE(std::isfinite(*health.imu->gyro_turn_rad));
}

constexpr const char* kSteppingBack =
    "FLASER 2 1 2 0 0 0 0 0 0 1.5 h 1.5\n"
    "# a comment takes a line\n"
    "FLASER 2 1 2 0 0 0 0.1 0 0 1.0 h 1.0\n";

TEST(ReadLogAsFound, KeepsWhatReadLogRefusesAndKnowsItsLines) {
  const ScratchFolder folder;
  write_text(folder / "a.clf", kSteppingBack);
  write_text(folder / "a.tum", "1.0 0 0\n");
  EXPECT_FALSE(read_log(folder / "a.clf").has_value());
  const auto found = read_log_as_found(folder / "a.clf");
  ASSERT_TRUE(found.has_value()) << found.error().to_line();
  EXPECT_EQ(found->log.num_scans(), 2U);
  EXPECT_EQ(found->origins.size(), found->log.events.size());
  EXPECT_FALSE(found->log.truth.has_value());
  const std::string notes = all_lines(found->log.provenance.notes);
  EXPECT_NE(notes.find("a.clf: line 3: stamp steps back by"), std::string::npos) << notes;
  EXPECT_EQ(notes.find("a.tum"), std::string::npos) << notes;
  ASSERT_TRUE(found->refused_truth.has_value());
  EXPECT_EQ(found->refused_truth->where, (folder / "a.tum").string() + ":1");
  const LogHealth health = examine(found->log, {found->origins, found->origin_unit});
  EXPECT_NE(all_lines(health.defects).find("line 3, event 2: stamp steps back"), std::string::npos)
      << all_lines(health.defects);
  EXPECT_EQ(health.lidar_stamps.first_bad_at, "line 3");
}

TEST(ReadLogAsFound, RefusesWhatIsNoLog) {
  const ScratchFolder folder;
  write_text(folder / "a.clf", "FLASER two 1 2\n");
  EXPECT_FALSE(read_log_as_found(folder / "a.clf").has_value());
  write_text(folder / "b.clf", "");
  EXPECT_FALSE(read_log_as_found(folder / "b.clf").has_value());
}

// Chords of 1 m: along the heading, across it, and on an arc of a quarter turn, whose chord is half
// of the turn off the heading it begins with.
TEST(LogHealth, SharesTheWayAcrossTheHeadingsByHand) {
  SensorLog log;
  const auto add = [&log](const Pose2& T_odom_base) {
    const auto second = static_cast<std::int64_t>(log.events.size()) * 1'000'000'000;
    log.events.emplace_back(WheelSample{{second}, T_odom_base, std::nullopt});
    return examine(log).wheels->sideways_ratio;
  };
  const double half = std::sqrt(0.5);
  add(Pose2(0, 0, 0));
  EXPECT_DOUBLE_EQ(add(Pose2(1, 0, 0)), 0);
  EXPECT_DOUBLE_EQ(add(Pose2(1, 1, 0)), 0.5);
  EXPECT_NEAR(add(Pose2(1 + half, 1 + half, std::acos(-1) / 2)), 1.0 / 3, 1e-12);
  EXPECT_NEAR(add(Pose2(1 + half, 1.05 + half, 3)), 1.0 / 3, 1e-12) << "too short to count";
  EXPECT_EQ(examine(log).wheels->num_chords, 3U);
}

}  // namespace
}  // namespace corridor::formats
