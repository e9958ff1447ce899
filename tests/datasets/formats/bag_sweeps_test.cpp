// When each beam of a ROS scan was taken: sweeps of either direction, each with its own duration.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "datasets/formats/log_io.hpp"
#include "tests/datasets/formats/bag_support.hpp"
#include "tests/datasets/formats/formats_support.hpp"

namespace corridor::formats {
namespace {

using test::ScratchFolder;
using test::small_bag;
using test::write_bag;
using test::write_text;

std::string notes_of(const SensorLog& log) {
  std::string notes;
  for (const std::string& note : log.provenance.notes) notes += note + "\n";
  return notes;
}

// The scans of `log`, in order.
std::vector<LaserScan> scans_of(const SensorLog& log) {
  std::vector<LaserScan> scans;
  for (const SensorEvent& event : log.events) {
    if (const auto* scan = std::get_if<LaserScan>(&event)) scans.push_back(*scan);
  }
  return scans;
}

// The same sweep seen by a LiDAR that turns the other way: its last beam comes first.
void turn_clockwise(ros1::Scan& scan) {
  std::swap(scan.angle_min_rad, scan.angle_max_rad);
  scan.angle_increment_rad = -scan.angle_increment_rad;
  std::reverse(scan.ranges_m.begin(), scan.ranges_m.end());
}

TEST(BagSweeps, AClockwiseScanIsTurnedRound) {
  auto messages = small_bag();
  for (ros1::Message& message : messages) {
    if (auto* scan = std::get_if<ros1::Scan>(&message.content)) turn_clockwise(*scan);
  }
  const ScratchFolder folder;
  write_bag(folder / "clockwise.bag", messages);
  write_bag(folder / "a.bag", small_bag());
  const auto read = read_log(folder / "clockwise.bag");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  EXPECT_TRUE(test::same_events(*read, *read_log(folder / "a.bag")));
  EXPECT_NE(notes_of(*read).find("5 clockwise scans"), std::string::npos);
}

// What counts is the moment at which each direction was measured, whichever way the LiDAR turns.
TEST(BagSweeps, EveryBeamKeepsItsMomentInScansOfEitherDirection) {
  constexpr float kBeamStep_s = 0.0078125F;
  auto messages = small_bag();
  for (std::size_t i = 0; i < messages.size(); ++i) {
    auto* scan = std::get_if<ros1::Scan>(&messages[i].content);
    if (scan == nullptr) continue;
    scan->time_increment_s = kBeamStep_s;
    if (i % 2 == 0) turn_clockwise(*scan);
  }
  const ScratchFolder folder;
  write_bag(folder / "a.bag", messages);
  const auto read = read_log(folder / "a.bag");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  const std::vector<LaserScan> scans = scans_of(*read);
  std::size_t index = 0;
  std::size_t num_clockwise = 0;
  for (const ros1::Message& message : messages) {
    const auto* scan = std::get_if<ros1::Scan>(&message.content);
    if (scan == nullptr) continue;
    const LaserScan& taken = scans.at(index++);
    num_clockwise += scan->angle_increment_rad < 0 ? 1 : 0;
    EXPECT_EQ(taken.duration_s < 0, scan->angle_increment_rad < 0);
    for (std::size_t beam = 0; beam < scan->ranges_m.size(); ++beam) {
      const double angle_rad =
          scan->angle_min_rad + static_cast<double>(beam) * scan->angle_increment_rad;
      const auto same =
          static_cast<std::size_t>(std::lround((angle_rad - taken.angle_min_rad) / 0.25));
      EXPECT_EQ(taken.ranges_m.at(same), scan->ranges_m[beam]);
      const double moment_s =
          static_cast<double>(taken.stamp.nanoseconds - message.stamp_ns) * 1e-9 +
          taken.beam_time_s(same);
      EXPECT_NEAR(moment_s, static_cast<double>(beam) * kBeamStep_s, 1e-9);
    }
  }
  EXPECT_EQ(index, 5U);
  EXPECT_GT(num_clockwise, 0U);
  EXPECT_LT(num_clockwise, 5U);
}

TEST(BagSweeps, ScansKeepTheirOwnDurationsWithTheirSigns) {
  SensorLog log = test::small_log();
  const std::vector<double> durations_s = {-0.0625, -0.125, 0.0625, -0.0625};
  std::size_t index = 0;
  for (SensorEvent& event : log.events) {
    if (auto* scan = std::get_if<LaserScan>(&event)) scan->duration_s = durations_s.at(index++);
  }
  const ScratchFolder folder;
  ASSERT_TRUE(write_rosbag(log, folder / "a.bag"));
  const auto read = read_log(folder / "a.bag");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  const std::vector<LaserScan> written = scans_of(log);
  const std::vector<LaserScan> scans = scans_of(*read);
  ASSERT_EQ(scans.size(), durations_s.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    // A beam's step is a 32-bit float.
    EXPECT_NEAR(scans[i].duration_s, durations_s[i], 1e-8) << i;
    EXPECT_EQ(scans[i].stamp, written[i].stamp) << i;
    EXPECT_EQ(scans[i].ranges_m, written[i].ranges_m) << i;
  }
  EXPECT_NEAR(read->robot.lidar.scan_duration_s, -0.0625, 1e-8);
}

TEST(BagSweeps, TheSidecarsSweepGoesBeforeTheScans) {
  auto messages = small_bag();
  for (ros1::Message& message : messages) {
    if (auto* scan = std::get_if<ros1::Scan>(&message.content)) scan->time_increment_s = 0.015625F;
  }
  const ScratchFolder folder;
  write_bag(folder / "a.bag", messages);
  write_text(folder / "a.robot.toml", "[lidar]\nscan_duration_s = 0.05\n");
  const auto read = read_log(folder / "a.bag");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  for (const LaserScan& scan : scans_of(*read)) EXPECT_EQ(scan.duration_s, 0.05);
  EXPECT_NE(notes_of(*read).find("0.05 s by the sidecar, 0.0625 s"), std::string::npos);
}

// A duration alone does not say whether the stamp is that of the first beam or of the last.
TEST(BagSweeps, ASweepThatOnlyTheModelKnowsIsRefusedForClockwiseScans) {
  for (const float increment_s : {0.0F, 0.015625F}) {
    auto messages = small_bag();
    for (ros1::Message& message : messages) {
      if (auto* scan = std::get_if<ros1::Scan>(&message.content)) {
        turn_clockwise(*scan);
        scan->time_increment_s = increment_s;
      }
    }
    const ScratchFolder folder;
    write_bag(folder / "a.bag", messages);
    EXPECT_TRUE(read_log(folder / "a.bag").has_value());
    write_text(folder / "a.robot.toml", "[lidar]\nscan_duration_s = 0.05\n");
    const auto read = read_log(folder / "a.bag");
    ASSERT_FALSE(read.has_value());
    EXPECT_NE(read.error().to_line().find("lidar.scan_duration_s = 0.05 for clockwise scans"),
              std::string::npos)
        << read.error().to_line();
  }
}

}  // namespace
}  // namespace corridor::formats
