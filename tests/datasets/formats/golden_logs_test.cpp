// Logs put together byte by byte outside of this code base (tests/golden/README.md), value by
// value.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "datasets/formats/log_io.hpp"
#include "tests/datasets/formats/formats_support.hpp"
#include "tests/datasets/formats/golden_support.hpp"

namespace corridor::formats {
namespace {

using test::golden_file;
using test::golden_parts;
using test::ScratchFolder;
using test::write_text;

using Ranges = std::vector<float>;
using Validity = std::vector<std::uint8_t>;

SensorLog read_golden(const std::filesystem::path& path) {
  auto log = read_log(path);
  EXPECT_TRUE(log.has_value()) << log.error().to_line();
  return log ? std::move(*log) : SensorLog{};
}

// A log whose input has two parts: LOG.robot.toml and the log.
SensorLog read_with_calibration(const std::string& name, const std::string& file) {
  const ScratchFolder folder;
  const auto [robot, log] = golden_parts(name);
  write_text(folder / "a.robot.toml", robot);
  write_text(folder / file, log);
  return read_golden(folder / file);
}

template <class T>
const T& reading(const SensorLog& log, std::size_t index) {
  return std::get<T>(log.events.at(index));
}

void expect_wheels(const SensorEvent& event, std::int64_t stamp_ns, const Pose2& T_odom_base) {
  ASSERT_TRUE(std::holds_alternative<WheelSample>(event));
  const auto& sample = std::get<WheelSample>(event);
  EXPECT_EQ(sample.stamp.nanoseconds, stamp_ns);
  EXPECT_LT(sample.T_odom_base.minus(T_odom_base).norm(), 1e-15);
}

void expect_scan(const SensorEvent& event, std::int64_t stamp_ns, const Ranges& ranges_m,
                 const Validity& is_valid) {
  ASSERT_TRUE(std::holds_alternative<LaserScan>(event));
  const auto& scan = std::get<LaserScan>(event);
  EXPECT_EQ(scan.stamp.nanoseconds, stamp_ns);
  EXPECT_EQ(scan.ranges_m, ranges_m);
  EXPECT_EQ(scan.is_valid, is_valid);
}

TEST(GoldenLogs, CarmenFlaser) {
  const SensorLog log = read_golden(golden_file("carmen/flaser.clf"));
  ASSERT_EQ(log.events.size(), 6U);
  expect_wheels(log.events[0], 100'000'000'000, Pose2(0, 0, 0));
  expect_wheels(log.events[1], 100'100'000'000, Pose2(0.05, 0, 0));
  expect_scan(log.events[2], 100'100'000'000, {1, 1.5F, 82, 0}, {1, 1, 0, 0});
  expect_wheels(log.events[3], 100'200'000'000, Pose2(0.1, 0, 0.01));
  expect_wheels(log.events[4], 100'300'000'000, Pose2(0.15, 0, 0.01));
  expect_scan(log.events[5], 100'300'000'000, {1, 1.5F, 82, 2}, {1, 1, 0, 1});
  const auto& scan = reading<LaserScan>(log, 2);
  EXPECT_DOUBLE_EQ(scan.angle_min_rad, -std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(scan.angle_increment_rad, std::numbers::pi / 4);
  EXPECT_EQ(scan.range_max_m, 81);
}

TEST(GoldenLogs, CarmenRobotlaser) {
  const SensorLog log = read_golden(golden_file("carmen/robotlaser.clf"));
  ASSERT_EQ(log.events.size(), 4U);
  expect_wheels(log.events[0], 100'000'000'000, Pose2(0, 0, 0));
  expect_scan(log.events[1], 100'000'000'000, {1, 1.5F, 6, 2}, {1, 1, 0, 1});
  expect_wheels(log.events[2], 100'100'000'000, Pose2(0.05, 0, 0));
  expect_scan(log.events[3], 100'100'000'000, {1, 1.5F, 6, 2}, {1, 1, 0, 1});
  const auto& scan = reading<LaserScan>(log, 3);
  EXPECT_EQ(scan.angle_min_rad, -1.5708);
  EXPECT_EQ(scan.angle_increment_rad, 1.0472);
  EXPECT_EQ(scan.range_max_m, 5);
  EXPECT_EQ(scan.T_base_lidar, Pose2(0.1, 0, 0));
}

TEST(GoldenLogs, RawlogOfObservations) {
  const SensorLog log = read_golden(golden_file("rawlog/observations.rawlog"));
  EXPECT_EQ(log.robot.name, "seed");
  EXPECT_EQ(log.robot.wheels.track_m, 0.35);
  EXPECT_EQ(log.robot.lidar.T_base_lidar, Pose2(0.1, 0, 0));
  ASSERT_EQ(log.events.size(), 6U);
  expect_wheels(log.events[0], 980'000'000, Pose2(0, 0, 0));
  expect_wheels(log.events[3], 1'080'000'000, Pose2(0.05, 0, 0));
  EXPECT_EQ(reading<WheelSample>(log, 3).ticks->left, 500);
  EXPECT_EQ(reading<WheelSample>(log, 3).ticks->right, 510);
  const auto& imu = reading<ImuSample>(log, 4);
  EXPECT_EQ(imu.stamp.nanoseconds, 1'090'000'000);
  EXPECT_EQ(imu.gyro_z_radps, 0.01 * 3);
  EXPECT_EQ(imu.accel_x_mps2, 0);
  EXPECT_EQ(imu.accel_y_mps2, 0.01);
  expect_scan(log.events[2], 1'000'000'000, {1, 1.5F, 5.5F, 2}, {1, 1, 0, 1});
  expect_scan(log.events[5], 1'100'000'000, {1, 1.5F, 5.5F, 2}, {1, 1, 0, 1});
  const auto& scan = reading<LaserScan>(log, 5);
  EXPECT_EQ(scan.angle_min_rad, -0.75);
  EXPECT_EQ(scan.angle_increment_rad, 0.5);
  EXPECT_EQ(scan.range_max_m, 4.5);
  EXPECT_EQ(scan.T_base_lidar, Pose2(0.1, 0, 0));
}

TEST(GoldenLogs, RawlogOfActionsAndFrames) {
  const SensorLog log = read_golden(golden_file("rawlog/frames.rawlog"));
  ASSERT_EQ(log.events.size(), 6U);
  expect_wheels(log.events[0], 1'050'000'000, Pose2(0.05, 0, 0.01));
  expect_scan(log.events[1], 1'050'000'000, {1, 1.5F, 5.5F}, {1, 1, 0});
  expect_wheels(log.events[2], 1'150'000'000,
                Pose2(0.05 + 0.05 * std::cos(0.01), 0.05 * std::sin(0.01), 0.02));
  expect_scan(log.events[5], 1'250'000'000, {1, 1.5F, 5.5F}, {1, 1, 0});
  EXPECT_EQ(reading<LaserScan>(log, 1).angle_increment_rad, 0.75);
}

TEST(GoldenLogs, BagInEachCompression) {
  for (const char* name : {"none", "bz2", "lz4"}) {
    SCOPED_TRACE(name);
    const SensorLog log =
        read_golden(golden_file(std::string("bag_framing/scans-") + name + ".bag"));
    ASSERT_EQ(log.events.size(), 2U);
    expect_scan(log.events[0], 99'999'000'000, {1, 1.5F, 5.5F, 2}, {1, 1, 0, 1});
    expect_scan(log.events[1], 100'099'000'000, {1, 1.5F, 5.5F, 2}, {1, 1, 0, 1});
    const auto& scan = reading<LaserScan>(log, 1);
    EXPECT_EQ(scan.angle_min_rad, -0.375);
    EXPECT_EQ(scan.angle_increment_rad, 0.25);
    EXPECT_EQ(scan.range_min_m, 0.125);
    EXPECT_EQ(scan.range_max_m, 4.5);
  }
}

TEST(GoldenLogs, BagOfThreeSensors) {
  const SensorLog log = read_golden(golden_file("bag_framing/drive.bag"));
  ASSERT_EQ(log.events.size(), 6U);
  expect_wheels(log.events[0], 99'999'000'000, Pose2(0, 0, 0));
  expect_wheels(log.events[3], 100'099'000'000, Pose2(0.05, 0, 0));
  const auto& imu = reading<ImuSample>(log, 1);
  EXPECT_EQ(imu.stamp.nanoseconds, 100'000'000'000);
  EXPECT_EQ(imu.gyro_z_radps, 0.01);
  EXPECT_EQ(imu.accel_x_mps2, 0.25);
  EXPECT_EQ(imu.accel_y_mps2, -0.5);
  expect_scan(log.events[2], 100'001'000'000, {1, 1.5F, 5.5F, 2}, {1, 1, 0, 1});
}

// The message's first beam, at 0.375 rad, is taken at its stamp, its last one 3/64 s later.
TEST(GoldenLogs, BagOfAClockwiseLidar) {
  const SensorLog log = read_golden(golden_file("bag_framing/clockwise.bag"));
  ASSERT_EQ(log.events.size(), 2U);
  expect_scan(log.events[0], 99'999'000'000 + 46'875'000, {1, 1.5F, 5.5F, 2}, {1, 1, 0, 1});
  const auto& scan = reading<LaserScan>(log, 0);
  EXPECT_EQ(scan.angle_min_rad, -0.375);
  EXPECT_EQ(scan.angle_increment_rad, 0.25);
  EXPECT_EQ(scan.duration_s, -3.0 / 64);
}

TEST(GoldenLogs, Ticks) {
  const SensorLog log = read_with_calibration("ticks/two-rows.dat", "a.dat");
  ASSERT_EQ(log.events.size(), 4U);
  expect_wheels(log.events[0], 1'000'000'000, Pose2());
  const auto& sample = reading<WheelSample>(log, 2);
  EXPECT_EQ(sample.stamp.nanoseconds, 1'100'000'000);
  EXPECT_EQ(sample.ticks->left, 100);
  EXPECT_EQ(sample.ticks->right, 101);
  // 0.01 m and 0.0101 m on wheels 0.35 m apart.
  EXPECT_NEAR(sample.T_odom_base.x_m(), 0.01005, 1e-8);
  EXPECT_NEAR(sample.T_odom_base.theta_rad(), 1e-4 / 0.35, 1e-12);
  const auto& scan = reading<LaserScan>(log, 3);
  EXPECT_EQ(scan.stamp.nanoseconds, 1'100'000'000);
  ASSERT_EQ(scan.num_beams(), 543U);
  EXPECT_DOUBLE_EQ(scan.angle_increment_rad, 2 * std::numbers::pi / 1024);
  EXPECT_DOUBLE_EQ(scan.angle_min_rad, -270.5 * 2 * std::numbers::pi / 1024);
  EXPECT_EQ(scan.T_base_lidar, Pose2(0.1, 0, 0));
  for (std::size_t beam = 0; beam < scan.num_beams(); ++beam) {
    const bool is_hit = (beam + 70) % 100 == 0;  // of the 682 of a row the first 70 are left out
    EXPECT_EQ(scan.is_valid[beam], is_hit ? 1 : 0) << beam;
    EXPECT_EQ(scan.ranges_m[beam], is_hit ? 1.0F : 0.0F) << beam;
  }
}

TEST(GoldenLogs, Lcm) {
  const SensorLog log = read_with_calibration("lcm/data.lcm", "a.lcm");
  EXPECT_EQ(log.num_scans(), 3U);
  EXPECT_EQ(log.num_wheel_samples(), 3U);
  EXPECT_EQ(log.num_imu_samples(), 3U);
  ASSERT_TRUE(log.truth.has_value());
  EXPECT_TRUE(log.provenance.is_truth_reference);
  ASSERT_EQ(log.truth->size(), 3U);
  EXPECT_EQ((*log.truth)[2].stamp.nanoseconds, 100'205'000'000);
  EXPECT_EQ((*log.truth)[2].T_map_base, Pose2(0.2F, 0, 0));
  std::size_t num_wheels = 0;
  std::size_t num_imu = 0;
  for (const SensorEvent& event : log.events) {
    if (const auto* sample = std::get_if<WheelSample>(&event)) {
      const auto step = static_cast<std::int64_t>(num_wheels++);
      EXPECT_EQ(sample->stamp.nanoseconds, 100'000'000'000 + 100'000'000 * step);
      EXPECT_EQ(sample->ticks->left, 100 * step);
      EXPECT_EQ(sample->ticks->right, 101 * step);
    } else if (const auto* imu = std::get_if<ImuSample>(&event)) {
      const auto step = static_cast<std::int64_t>(num_imu++);
      EXPECT_EQ(imu->stamp.nanoseconds, 100'000'000'000 + 100'000'000 * step);
      EXPECT_NEAR(imu->gyro_z_radps, 131 / 131.07 * std::numbers::pi / 180, 1e-12);
      EXPECT_NEAR(imu->accel_x_mps2, 10 * 9.80665 / 16384, 1e-12);
      EXPECT_NEAR(imu->accel_y_mps2, 20 * 9.80665 / 16384, 1e-12);
    }
  }
}

// Beam i of the 40 of a turn: 1 + 0.05 i m, clockwise from above, 1 ms later than the one before.
TEST(GoldenLogs, LcmBeamsPointToTheRightOneAfterAnother) {
  const SensorLog log = read_with_calibration("lcm/data.lcm", "a.lcm");
  std::int64_t begin_ns = 100'000'000'000;
  for (const SensorEvent& event : log.events) {
    const auto* scan = std::get_if<LaserScan>(&event);
    if (scan == nullptr) continue;
    int num_valid = 0;
    for (std::size_t beam = 0; beam < scan->num_beams(); ++beam) {
      if (scan->is_valid[beam] == 0) continue;
      const double i = std::round((scan->ranges_m[beam] - 1) * 20);
      const double moment_s =
          static_cast<double>(scan->stamp.nanoseconds - begin_ns) * 1e-9 + scan->beam_time_s(beam);
      EXPECT_NEAR(wrap_angle(scan->angle_rad(beam) + 2 * std::numbers::pi * i / 40), 0, 1e-6);
      EXPECT_NEAR(moment_s, 1e-3 * i, 1e-6);
      ++num_valid;
    }
    EXPECT_EQ(num_valid, 40);
    begin_ns += 100'000'000;
  }
}

}  // namespace
}  // namespace corridor::formats
