// Golden counts of the recorded and simulated logs; each test skips itself where its file is not
// found.
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/formats/log_io.hpp"
#include "datasets/formats/robot_toml.hpp"
#include "datasets/formats/trajectories/relations.hpp"
#include "tests/datasets/formats/formats_support.hpp"
#include "tests/support/recorded_data.hpp"

namespace corridor::formats {
namespace {

using testing::missing_data_message;
using testing::recorded_file;

std::vector<const LaserScan*> scans_of(const SensorLog& log) {
  std::vector<const LaserScan*> scans;
  for (const auto& event : log.events) {
    if (const auto* scan = std::get_if<LaserScan>(&event)) scans.push_back(scan);
  }
  return scans;
}

double path_length_m(const SensorLog& log) {
  double length_m = 0;
  const WheelSample* last = nullptr;
  for (const auto& event : log.events) {
    const auto* sample = std::get_if<WheelSample>(&event);
    if (sample == nullptr) continue;
    if (last != nullptr)
      length_m += last->T_odom_base.between(sample->T_odom_base).translation_m().norm();
    last = sample;
  }
  return length_m;
}

struct RecordedLog {
  const char* name;
  std::size_t num_scans;
  std::size_t num_beams;
  double no_return_range_m;
  double path_m;
  std::size_t num_relations;
};

class RecordedLogs : public ::testing::TestWithParam<RecordedLog> {};

TEST_P(RecordedLogs, HaveTheirPublishedCounts) {
  const RecordedLog& expected = GetParam();
  const std::string file = std::string("recorded/") + expected.name + ".clf.gz";
  const auto path = recorded_file(file);
  if (!path) GTEST_SKIP() << missing_data_message(file);
  ReadLogOptions options;
  options.no_return_range_m = expected.no_return_range_m;
  const auto log = read_log(*path, options);
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  EXPECT_EQ(log->num_scans(), expected.num_scans);
  EXPECT_EQ(log->num_wheel_samples(), expected.num_scans);
  const auto scans = scans_of(*log);
  EXPECT_EQ(scans.front()->num_beams(), expected.num_beams);
  EXPECT_NEAR(scans.front()->angle_min_rad, -std::acos(-1) / 2, 1e-12);
  // The odometry path of aces and fr079 jitters; the README's lengths are rounded.
  EXPECT_NEAR(path_length_m(*log), expected.path_m, 0.02 * expected.path_m);
  if (expected.num_relations == 0) return;
  const auto relations = read_relations(sidecar_of(*path, ".relations"));
  ASSERT_TRUE(relations.has_value()) << relations.error().to_line();
  EXPECT_EQ(relations->size(), expected.num_relations);
}

INSTANTIATE_TEST_SUITE_P(All, RecordedLogs,
                         ::testing::Values(RecordedLog{"intel", 13631, 180, 81, 508, 2984},
                                           RecordedLog{"fr079", 4934, 360, 81, 393, 1685},
                                           RecordedLog{"aces", 7374, 180, 50, 325, 0}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(RecordedLogs, RelationsOfIntelNameStampsOfScans) {
  const auto path = recorded_file("recorded/intel.clf.gz");
  if (!path) GTEST_SKIP() << missing_data_message("recorded/intel.clf.gz");
  std::vector<Timestamp> stamps;
  const auto log = read_log(*path);
  for (const LaserScan* scan : scans_of(*log)) stamps.push_back(scan->stamp);
  const auto relations = read_relations(sidecar_of(*path, ".relations"));
  for (const Relation& relation : *relations) {
    EXPECT_TRUE(std::binary_search(stamps.begin(), stamps.end(), relation.t1));
    EXPECT_TRUE(std::binary_search(stamps.begin(), stamps.end(), relation.t2));
  }
}

class CorridorLogs : public ::testing::TestWithParam<const char*> {};

TEST_P(CorridorLogs, HaveTruthAtTheStampOfEveryScan) {
  const std::string file = std::string("corridor/") + GetParam() + ".rawlog";
  const auto path = recorded_file(file);
  if (!path) GTEST_SKIP() << missing_data_message(file);
  const auto log = read_log(*path);
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  ASSERT_TRUE(log->truth.has_value());
  const auto scans = scans_of(*log);
  ASSERT_EQ(scans.size(), log->truth->size());
  for (std::size_t i = 0; i < scans.size(); ++i) EXPECT_EQ(scans[i]->stamp, (*log->truth)[i].stamp);
  EXPECT_EQ(scans.front()->num_beams(), 360U);
  EXPECT_EQ(log->robot.name, "corridor robot");
  EXPECT_EQ(log->robot.lidar.range_max_m, std::string(GetParam()) == "r12-s1" ? 12 : 4.5);
  EXPECT_EQ(log->robot.imu.rate_hz, 200);
  EXPECT_NEAR(static_cast<double>(log->num_imu_samples()) / log->duration_s(), 200, 1);
}

TEST_P(CorridorLogs, HaveTheSameScansAsRawlogAndAsCarmenText) {
  const std::string file = std::string("corridor/") + GetParam() + ".rawlog";
  const auto path = recorded_file(file);
  if (!path) GTEST_SKIP() << missing_data_message(file);
  const auto rawlog = read_log(*path);
  const auto carmen = read_log(sidecar_of(*path, ".clf.gz"));
  ASSERT_TRUE(rawlog.has_value() && carmen.has_value());
  const auto a = scans_of(*rawlog);
  const auto b = scans_of(*carmen);
  ASSERT_EQ(a.size(), b.size());
  constexpr double kPrinted_m = 0.00051;  // three decimals
  constexpr double kPrinted_rad = 1e-6;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i]->stamp, b[i]->stamp);
    ASSERT_NEAR(a[i]->angle_rad(0), b[i]->angle_rad(0), kPrinted_rad);
    ASSERT_NEAR(a[i]->angle_rad(359), b[i]->angle_rad(359), 360 * kPrinted_rad);
    ASSERT_EQ(a[i]->num_beams(), b[i]->num_beams());
    for (std::size_t beam = 0; beam < a[i]->num_beams(); ++beam) {
      ASSERT_NEAR(a[i]->ranges_m[beam], b[i]->ranges_m[beam], kPrinted_m);
      // A return printed as the limit itself counts as none.
      const bool is_at_limit = std::abs(a[i]->ranges_m[beam] - a[i]->range_max_m) < kPrinted_m;
      if (is_at_limit) continue;
      ASSERT_EQ(a[i]->is_valid[beam], b[i]->is_valid[beam]);
    }
  }
}

// What the file holds is what our writer can hold, so that nothing may change.
TEST_P(CorridorLogs, AreUnchangedByOurWriter) {
  const std::string file = std::string("corridor/") + GetParam() + ".rawlog";
  const auto path = recorded_file(file);
  if (!path) GTEST_SKIP() << missing_data_message(file);
  const auto log = read_log(*path);
  ASSERT_TRUE(log.has_value());
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_log(*log, folder / "again.rawlog"));
  const auto again = read_log(folder / "again.rawlog");
  ASSERT_TRUE(again.has_value()) << again.error().to_line();
  EXPECT_TRUE(test::same_events(*log, *again));
  EXPECT_EQ(robot_to_toml(log->robot), robot_to_toml(again->robot));
}

// Debian's mrpt-common installs it; the folder of the recorded data is not needed.
TEST(MalagaLog, HasItsPublishedCountsAndItsMountedLidar) {
  const std::filesystem::path path =
      "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "Debian's mrpt-common is not installed";
  const auto log = read_log(path);
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  EXPECT_EQ(log->num_scans(), 225U);
  EXPECT_EQ(log->num_wheel_samples(), 225U);
  EXPECT_NEAR(path_length_m(*log), 76, 1);
  const auto scans = scans_of(*log);
  EXPECT_EQ(scans.front()->num_beams(), 361U);
  EXPECT_EQ(scans.front()->T_base_lidar, log->robot.lidar.T_base_lidar);
  EXPECT_NEAR(scans.front()->T_base_lidar.x_m(), 0.78, 1e-6);
  EXPECT_EQ(scans.front()->range_max_m, 80);
  // Wheels come first at each stamp.
  EXPECT_TRUE(std::holds_alternative<WheelSample>(log->events[0]));
  EXPECT_EQ(stamp_of(log->events[0]), stamp_of(log->events[1]));
}

INSTANTIATE_TEST_SUITE_P(All, CorridorLogs,
                         ::testing::Values("r4.5-s1", "r4.5-s2", "r4.5-s3", "r4.5-s4", "r4.5-s5",
                                           "r4.5-s6", "r4.5-slip-s7", "r4.5-vary-s8", "r12-s1"),
                         [](const auto& test) {
                           std::string name = test.param;
                           for (char& c : name) c = c == '.' || c == '-' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace corridor::formats
