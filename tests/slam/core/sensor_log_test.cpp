#include "slam/core/sensor_log.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace corridor {
namespace {

constexpr std::size_t kNumBeams = 4;

LaserScan scan_at(double time_s) {
  LaserScan scan;
  scan.stamp = timestamp_from_seconds(time_s);
  scan.angle_min_rad = -1;
  scan.angle_increment_rad = 0.5;
  scan.range_min_m = 0.05;
  scan.range_max_m = 10;
  scan.ranges_m.assign(kNumBeams, 2.0f);
  scan.is_valid.assign(kNumBeams, 1);
  return scan;
}

WheelSample wheels_at(double time_s, const Pose2& T_odom_base) {
  return {timestamp_from_seconds(time_s), T_odom_base, std::nullopt};
}

ImuSample imu_at(double time_s, double gyro_radps = 0) {
  return {timestamp_from_seconds(time_s), gyro_radps, 0, 0};
}

// Half a second at 0.5 m/s: wheels, IMU and scan at equal stamps, 0.1 s apart.
SensorLog sound_log() {
  SensorLog log;
  for (int i = 1; i <= 5; ++i) {
    const double time_s = 0.1 * i;
    log.events.emplace_back(wheels_at(time_s, {0.5 * time_s, 0, 0}));
    log.events.emplace_back(imu_at(time_s));
    log.events.emplace_back(scan_at(time_s));
  }
  return log;
}

LaserScan& scan_in(SensorLog& log, std::size_t index) {
  return std::get<LaserScan>(log.events[index]);
}

// The one line that the log is answered with.
std::string only_defect(const SensorLog& log) {
  const auto lines = defects(log);
  EXPECT_EQ(lines.size(), 1u);
  return lines.empty() ? "no defect" : lines.front();
}

::testing::AssertionResult starts_with(const std::string& line, const std::string& beginning) {
  if (line.rfind(beginning, 0) == 0) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "\"" << line << "\"";
}

TEST(SensorLog, SoundLogHasNoDefects) {
  EXPECT_EQ(defects(sound_log()), std::vector<std::string>{});
}

TEST(SensorLog, CountsItsReadingsAndItsDuration) {
  const SensorLog log = sound_log();
  EXPECT_EQ(log.num_scans(), 5u);
  EXPECT_EQ(log.num_wheel_samples(), 5u);
  EXPECT_EQ(log.num_imu_samples(), 5u);
  EXPECT_NEAR(log.duration_s(), 0.4, 1e-12);
  EXPECT_EQ(SensorLog().duration_s(), 0);
}

TEST(Defects, EmptyLog) {
  EXPECT_TRUE(starts_with(only_defect(SensorLog()), "the log has no events"));
}

TEST(Defects, LogWithoutScan) {
  SensorLog log;
  log.events.emplace_back(imu_at(1));
  EXPECT_TRUE(starts_with(only_defect(log), "the log has no LiDAR scan"));
}

TEST(Defects, RobotModelThatBreaksItsRules) {
  SensorLog log = sound_log();
  log.robot.wheels.track_m = -0.35;
  EXPECT_TRUE(starts_with(only_defect(log), "robot model: wheels.track_m = -0.35"));
}

TEST(Defects, StampThatStepsBack) {
  SensorLog log = sound_log();
  std::swap(log.events[5], log.events[6]);  // a scan after the next wheel sample
  EXPECT_TRUE(starts_with(only_defect(log), "event 6: stamp steps back by 0.100000 s"));
}

TEST(Defects, StampThatASensorRepeats) {
  SensorLog log = sound_log();
  log.events.insert(log.events.begin() + 2, log.events[1]);
  EXPECT_TRUE(starts_with(only_defect(log), "event 2: IMU sample repeats the stamp"));
}

TEST(Defects, StampThatComesAgainWithAnotherReading) {
  const std::string kinds[] = {
      "wheel sample repeats the stamp of the one before, which has another pose",
      "IMU sample repeats the stamp of the one before, which has other values",
      "scan repeats the stamp of the one before, which has other ranges"};
  for (std::size_t kind = 0; kind < 3; ++kind) {
    SensorLog log = sound_log();
    SensorEvent other = log.events[3 + kind];  // the next reading of the sensor, but a scan's
    if (auto* scan = std::get_if<LaserScan>(&other)) scan->ranges_m[1] = 3;
    if (auto* imu = std::get_if<ImuSample>(&other)) imu->gyro_z_radps = 0.1;
    std::visit([](auto& reading) { reading.stamp = timestamp_from_seconds(0.1); }, other);
    log.events.insert(log.events.begin() + 3, other);
    EXPECT_TRUE(starts_with(only_defect(log), "event 3: " + kinds[kind]));
  }
}

TEST(Defects, GapInOneSensorWhileOthersGoOn) {
  SensorLog log = sound_log();
  for (int i = 6; i <= 120; ++i) log.events.emplace_back(imu_at(0.1 * i));
  log.events.emplace_back(wheels_at(12.0, {1, 0, 0}));
  log.events.emplace_back(scan_at(12.0));
  const auto lines = defects(log);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_TRUE(starts_with(lines[0], "event 130: gap of 11.500 s between two wheel samples"));
  EXPECT_TRUE(starts_with(lines[1], "event 131: gap of 11.500 s between two scans"));
}

TEST(Defects, GapIsJudgedByTheLimitGiven) {
  SensorLog log = sound_log();
  EXPECT_EQ(defects(log, {.max_gap_s = 0.09}).size(), 12u);  // four steps of each sensor
}

TEST(Defects, ScanWithoutBeams) {
  SensorLog log = sound_log();
  scan_in(log, 2).ranges_m.clear();
  scan_in(log, 2).is_valid.clear();
  EXPECT_TRUE(starts_with(only_defect(log), "event 2: scan with 0 ranges and 0 validities"));
}

TEST(Defects, ScanWhoseArraysDiffer) {
  SensorLog log = sound_log();
  scan_in(log, 2).is_valid.pop_back();
  EXPECT_TRUE(starts_with(only_defect(log), "event 2: scan with 4 ranges and 3 validities"));
}

TEST(Defects, BeamCountThatChanges) {
  SensorLog log = sound_log();
  scan_in(log, 14).ranges_m.push_back(1);
  scan_in(log, 14).is_valid.push_back(1);
  EXPECT_TRUE(starts_with(only_defect(log), "event 14: scan of 5 beams; expected 4"));
}

TEST(Defects, ScanGeometryThatIsNotFinite) {
  SensorLog log = sound_log();
  scan_in(log, 2).angle_increment_rad = NAN;
  EXPECT_TRUE(starts_with(only_defect(log), "event 2: scan geometry or duration is not finite"));
  log = sound_log();
  scan_in(log, 2).T_base_lidar = Pose2(NAN, 0, 0);
  EXPECT_TRUE(starts_with(only_defect(log), "event 2: scan geometry or duration is not finite"));
}

TEST(Defects, ValidRangeThatNoSensorGives) {
  for (const float range_m : {0.0f, -1.0f, 10.5f, std::numeric_limits<float>::quiet_NaN(),
                              std::numeric_limits<float>::infinity()}) {
    SensorLog log = sound_log();
    scan_in(log, 2).ranges_m[3] = range_m;
    EXPECT_TRUE(starts_with(only_defect(log), "event 2: beam 3 is marked valid")) << range_m;
  }
}

TEST(Defects, InvalidBeamMayHoldAnyRange) {
  SensorLog log = sound_log();
  scan_in(log, 2).ranges_m[3] = 11;
  scan_in(log, 2).is_valid[3] = 0;
  EXPECT_EQ(defects(log), std::vector<std::string>{});
}

TEST(Defects, OdometryThatIsNotFinite) {
  SensorLog log = sound_log();
  std::get<WheelSample>(log.events[3]).T_odom_base = Pose2(0, NAN, 0);
  EXPECT_TRUE(starts_with(only_defect(log), "event 3: odometry pose is not finite"));
}

TEST(Defects, OdometryTooFastForItsUnit) {
  SensorLog log = sound_log();
  std::get<WheelSample>(log.events[12]).T_odom_base = Pose2(250, 0, 0);  // millimetres for metres
  EXPECT_TRUE(starts_with(only_defect(log), "event 12: odometry moves 249.800 m in 0.1000 s"));
}

TEST(Defects, ImuReadingThatIsNotFinite) {
  SensorLog log = sound_log();
  std::get<ImuSample>(log.events[4]).accel_y_mps2 = INFINITY;
  EXPECT_TRUE(starts_with(only_defect(log), "event 4: IMU reading is not finite"));
}

TEST(Defects, YawRateTooFastForItsUnit) {
  SensorLog log = sound_log();
  std::get<ImuSample>(log.events[4]).gyro_z_radps = -45;  // degrees per second
  EXPECT_TRUE(starts_with(only_defect(log), "event 4: yaw rate -45.000 rad/s"));
}

// Scans every second from 1 s to 30 s, with `num` wheel samples at the first seconds.
SensorLog log_with_wheels_until(int num) {
  SensorLog log;
  for (int second = 1; second <= 30; ++second) {
    if (second <= num) log.events.emplace_back(wheels_at(second, Pose2()));
    log.events.emplace_back(scan_at(second));
  }
  return log;
}

TEST(Defects, SensorThatEndsLongBeforeTheLog) {
  EXPECT_TRUE(defects(log_with_wheels_until(20)).empty());
  EXPECT_EQ(only_defect(log_with_wheels_until(2)),
            "event 2: the last wheel sample comes 28.000 s before the log's end; expected at most "
            "10 s");
}

TEST(Defects, SensorThatBeginsLongAfterTheLog) {
  SensorLog log = log_with_wheels_until(0);
  log.events.emplace_back(imu_at(30));
  EXPECT_EQ(only_defect(log),
            "event 30: the first IMU sample comes 29.000 s after the log's first reading; expected "
            "at most 10 s");
}

// Wheels at 50 Hz that drive ahead and turn at the same rates for 2 s.
SensorLog fast_wheels(double speed_mps, double yaw_rate_radps) {
  SensorLog log;
  for (int i = 1; i <= 100; ++i) {
    const double time_s = 0.02 * i;
    log.events.emplace_back(
        wheels_at(time_s, Pose2(speed_mps * time_s, 0, yaw_rate_radps * time_s)));
  }
  log.events.emplace_back(scan_at(2));
  return log;
}

// Steps of 0.4 m hide below the half metre that one step may jump.
TEST(Defects, OdometryInCentimetresAtAHighRate) {
  EXPECT_TRUE(defects(fast_wheels(2, 0)).empty());
  const auto lines = defects(fast_wheels(20, 0));
  ASSERT_FALSE(lines.empty());
  EXPECT_TRUE(starts_with(lines.front(), "event 11: odometry moves 4.400 m in 0.2200 s; expected"));
}

TEST(Defects, OdometryInDegrees) {
  EXPECT_TRUE(defects(fast_wheels(0, 4)).empty());
  const auto lines = defects(fast_wheels(0, 0.5 * 57.29578));
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.front().find("odometry turns"), std::string::npos);
  EXPECT_NE(lines.front().find("expected at most 20 rad/s (degrees?)"), std::string::npos);
}

// 2 s in a thousandth of the time: no window is ever full.
TEST(Defects, OdometryOfALogShorterThanTheSpeedsWindow) {
  for (const auto& [log, part] :
       {std::pair(fast_wheels(2, 0), "odometry moves 3.960 m in 0.0020 s"),
        std::pair(fast_wheels(0, 4), "odometry turns 7.920 rad in")}) {
    SensorLog squeezed = log;
    EXPECT_TRUE(defects(squeezed).empty());
    for (SensorEvent& event : squeezed.events) {
      std::visit([](auto& reading) { reading.stamp.nanoseconds /= 1000; }, event);
    }
    EXPECT_NE(only_defect(squeezed).find(part), std::string::npos) << only_defect(squeezed);
  }
}

TEST(Defects, OdometryOfTheRestAfterTheLastFullWindow) {
  SensorLog log = fast_wheels(1, 0);
  for (int i = 1; i <= 4; ++i) {
    log.events.emplace_back(wheels_at(2 + 1e-3 * i, Pose2(2 + 0.2 * i, 0, 0)));
  }
  EXPECT_NE(only_defect(log).find("odometry moves"), std::string::npos);
  // Within what a clock that jitters does to a sound drive.
  log.events.resize(log.events.size() - 3);
  EXPECT_TRUE(defects(log).empty());
}

TEST(Defects, AccelerationOfNoRobot) {
  SensorLog log = sound_log();
  std::get<ImuSample>(log.events[4]).accel_y_mps2 = -1e9;
  EXPECT_EQ(only_defect(log),
            "event 4: acceleration 1000000000.000 m/s2; expected at most 200 (raw counts?)");
}

TEST(Defects, AreAllListedUpToTheLimitOfLines) {
  SensorLog log = sound_log();
  for (std::size_t i = 1; i < log.events.size(); i += 3) {
    std::get<ImuSample>(log.events[i]).gyro_z_radps = NAN;
  }
  EXPECT_EQ(defects(log).size(), 5u);
  EXPECT_EQ(defects(log, {}, 3).size(), 3u);
}

}  // namespace
}  // namespace corridor
