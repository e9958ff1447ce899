// What is written is read again: by whom nothing is lost, and what a format cannot hold.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include "datasets/formats/log_io.hpp"
#include "slam/core/rng.hpp"
#include "slam/core/units.hpp"
#include "tests/datasets/formats/golden_support.hpp"

namespace corridor::formats {
namespace {

using test::golden_parts;
using test::read_text;
using test::ScratchFolder;
using test::small_log;
using test::write_text;

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

// Scans before the wheel samples of their stamps, as some recorders put them.
SensorLog with_scans_first(SensorLog log) {
  std::stable_sort(log.events.begin(), log.events.end(),
                   [](const SensorEvent& a, const SensorEvent& b) {
                     const auto key = [](const SensorEvent& event) {
                       return std::pair(stamp_of(event), !std::holds_alternative<LaserScan>(event));
                     };
                     return key(a) < key(b);
                   });
  return log;
}

TEST(WrittenLog, IsReadAgainInEveryFormat) {
  for (const char* name : {"a.clf", "a.clf.gz", "a.rawlog", "a.bag"}) {
    for (const SensorLog& log : {small_log(), with_scans_first(small_log())}) {
      const ScratchFolder folder;
      ASSERT_TRUE(write_log(log, folder / name));
      const auto good = check_written_log(log, folder / name);
      EXPECT_TRUE(good.has_value()) << name << ": " << good.error().to_line();
    }
  }
}

// Ends this process: with 0 if the log could not be written, for want of room, and nothing of it is
// left.
[[noreturn]] void write_where_files_end_at(std::uintmax_t num_bytes, const SensorLog& log,
                                           const ScratchFolder& folder, const std::string& name) {
  const rlimit limit{num_bytes, num_bytes};
  std::signal(SIGXFSZ, SIG_IGN);
  if (setrlimit(RLIMIT_FSIZE, &limit) != 0) std::_Exit(2);
  const auto refused = write_log(log, folder / name);
  if (refused) std::_Exit(3);
  const bool is_clear = refused.error().what.find("cannot be written: File too large") == 0 &&
                        refused.error().where == (folder / name).string();
  std::_Exit(is_clear && std::filesystem::is_empty(folder.path()) ? 0 : 1);
}

TEST(WrittenLogDeathTest, WithoutRoomIsAnErrorInEveryFormatAndLeavesNothing) {
  // Longer than a chunk of a bag, whose readings are not compressible.
  SensorLog log = small_log();
  const LaserScan scan = std::get<LaserScan>(log.events.back());
  Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    LaserScan next = scan;
    next.stamp.nanoseconds += 100'000'000LL * (i + 1);
    next.ranges_m.resize(360);
    for (float& range_m : next.ranges_m) range_m = static_cast<float>(rng.uniform(0.1, 4.4));
    next.is_valid.assign(360, 1);
    log.events.emplace_back(std::move(next));
  }
  for (const char* name : {"a.clf", "a.clf.gz", "a.rawlog", "a.bag"}) {
    const ScratchFolder whole;
    ASSERT_TRUE(write_log(log, whole / name));
    const std::uintmax_t num_bytes = std::filesystem::file_size(whole / name);
    for (const std::uintmax_t room :
         {std::uintmax_t{0}, std::uintmax_t{100}, num_bytes / 2, num_bytes - 1}) {
      const ScratchFolder folder;
      EXPECT_EXIT(write_where_files_end_at(room, log, folder, name), ::testing::ExitedWithCode(0),
                  "")
          << name << " with room for " << room << " of " << num_bytes << " bytes";
    }
  }
}

TEST(WrittenLog, CarmenKeepsTheWheelsPoseOfAScanThatStandsBeforeIt) {
  const SensorLog log = with_scans_first(small_log());
  EXPECT_EQ(readings_held(log, LogFormat::kCarmen),
            (ReadingCounts{4, small_log().num_wheel_samples(), 0}));
  EXPECT_EQ(joined(losses_of_conversion(log, LogFormat::kCarmen)).find("interpolated"),
            std::string::npos);
  const ScratchFolder folder;
  ASSERT_TRUE(write_log(log, folder / "a.clf"));
  ASSERT_TRUE(write_log(small_log(), folder / "b.clf"));
  EXPECT_EQ(read_text(folder / "a.clf"), read_text(folder / "b.clf"));
}

TEST(WrittenLog, WithoutWheelsBecomesNoCarmenLog) {
  SensorLog log = small_log();
  std::erase_if(log.events, [](const SensorEvent& event) {
    return std::holds_alternative<WheelSample>(event);
  });
  const ScratchFolder folder;
  const auto refused = write_log(log, folder / "a.clf");
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().to_line().find("no wheel sample; expected odometry"),
            std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// 1081 beams of a quarter of a degree in a sweep of 25 ms: no figure of the fan is a 32-bit float.
SensorLog with_fan(SensorLog log, double angle_min_rad) {
  for (SensorEvent& event : log.events) {
    auto* scan = std::get_if<LaserScan>(&event);
    if (scan == nullptr) continue;
    scan->angle_increment_rad = 0.25 * kRadPerDeg;
    scan->angle_min_rad = angle_min_rad;
    scan->duration_s = log.robot.lidar.scan_duration_s = 0.025;
    scan->ranges_m.assign(1081, 1);
    scan->is_valid.assign(1081, 1);
  }
  return log;
}

TEST(WrittenLog, RoundedAnglesAreLostOnlyWhereTheyTurnABeamByAMicroradian) {
  const SensorLog log = with_fan(small_log(), -135 * kRadPerDeg);
  for (const auto& [name, format] :
       {std::pair("a.rawlog", LogFormat::kRawlog), std::pair("a.bag", LogFormat::kRosbag)}) {
    const std::string losses = joined(losses_of_conversion(log, format));
    EXPECT_EQ(losses.find("angle"), std::string::npos) << losses;
    EXPECT_EQ(losses.find("sweep"), std::string::npos) << losses;
    const ScratchFolder folder;
    ASSERT_TRUE(write_log(log, folder / name));
    const auto read = read_log(folder / name);
    ASSERT_TRUE(read.has_value()) << read.error().to_line();
    for (const SensorEvent& event : read->events) {
      const auto* scan = std::get_if<LaserScan>(&event);
      if (scan == nullptr) continue;
      EXPECT_NEAR(scan->angle_rad(0), -135 * kRadPerDeg, 1e-6) << name;
      EXPECT_NEAR(scan->angle_rad(1080), 135 * kRadPerDeg, 1e-6) << name;
      EXPECT_NEAR(scan->duration_s, 0.025, 1e-6) << name;
    }
  }
  const SensorLog turned = with_fan(small_log(), -135 * kRadPerDeg + 30 * 360 * kRadPerDeg);
  EXPECT_NE(joined(losses_of_conversion(turned, LogFormat::kRosbag))
                .find("4 scans have beams turned by up to "),
            std::string::npos)
      << joined(losses_of_conversion(turned, LogFormat::kRosbag));
}

TEST(WrittenLog, StampsCloserThanTheFormatsStepAreFound) {
  SensorLog log = small_log();
  const auto& first = std::get<ImuSample>(log.events.front());
  log.events.insert(log.events.begin() + 1,
                    ImuSample{{first.stamp.nanoseconds + 10}, first.gyro_z_radps, 0, 0});
  const ScratchFolder folder;
  ASSERT_TRUE(write_log(log, folder / "a.rawlog"));
  const auto refused = check_written_log(log, folder / "a.rawlog");
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().to_line().find("cannot hold this log: stamp"), std::string::npos)
      << refused.error().to_line();
}

TEST(WrittenLog, LimitsBeyondAFloatAreFound) {
  for (const char* name : {"a.rawlog", "a.bag"}) {
    SensorLog log = small_log();
    log.robot.lidar.range_max_m = 1e39;
    for (SensorEvent& event : log.events) {
      if (auto* scan = std::get_if<LaserScan>(&event)) scan->range_max_m = 1e39;
    }
    const ScratchFolder folder;
    ASSERT_TRUE(write_log(log, folder / name));
    EXPECT_FALSE(check_written_log(log, folder / name).has_value()) << name;
  }
}

TEST(WrittenLog, AReadingTooFewIsFound) {
  const ScratchFolder folder;
  SensorLog log = small_log();
  ASSERT_TRUE(write_log(log, folder / "a.bag"));
  log.events.push_back(ImuSample{add_seconds(stamp_of(log.events.back()), 1), 0, 0, 0});
  const auto refused = check_written_log(log, folder / "a.bag");
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().to_line().find("41 inertial samples; expected"), std::string::npos)
      << refused.error().to_line();
}

TEST(WrittenLog, AReferenceNeverBecomesTruth) {
  const ScratchFolder folder;
  const auto [robot, bytes] = golden_parts("lcm/data.lcm");
  write_text(folder / "a.robot.toml", robot);
  write_text(folder / "a.lcm", bytes);
  const auto log = read_log(folder / "a.lcm");
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  ASSERT_TRUE(log->provenance.is_truth_reference);
  ASSERT_TRUE(write_log(*log, folder / "b.rawlog"));
  EXPECT_TRUE(std::filesystem::exists(folder / "b.reference.tum"));
  EXPECT_FALSE(std::filesystem::exists(folder / "b.tum"));
  const auto again = read_log(folder / "b.rawlog");
  ASSERT_TRUE(again.has_value()) << again.error().to_line();
  EXPECT_FALSE(again->truth.has_value());
  EXPECT_NE(joined(losses_of_conversion(*log, LogFormat::kRawlog))
                .find("3 poses that another program found are no truth"),
            std::string::npos);
}

TEST(WrittenLog, OfItsOwnFormatLosesNothing) {
  const ScratchFolder folder;
  const SensorLog log = small_log();
  for (const char* name : {"a.rawlog", "a.clf", "a.bag"}) {
    ASSERT_TRUE(write_log(log, folder / name));
    const auto read = read_log(folder / name);
    ASSERT_TRUE(read.has_value()) << read.error().to_line();
    EXPECT_EQ(joined(losses_of_conversion(*read, *format_from_suffix(name))), "") << name;
  }
}

TEST(ReadLog, NamesTheLineOfADefectAndCountsAllOthers) {
  std::string text;
  for (int i = 0; i < 40; ++i) {
    const std::string stamp = std::to_string(i + 1);
    text += "# line " + std::to_string(2 * i + 1) + "\nODOM " + std::to_string(100 * i) +
            " 0 0 0 0 0 " + stamp + " h " + stamp + "\n";
  }
  const ScratchFolder folder;
  write_text(folder / "a.clf", text);
  const auto refused = read_log(folder / "a.clf");
  ASSERT_FALSE(refused.has_value());
  // No scan, and 39 jumps of 100 m in a second.
  EXPECT_NE(refused.error().to_line().find("(and 39 more defects)"), std::string::npos)
      << refused.error().to_line();
  write_text(folder / "b.clf", text + "FLASER 1 2 3900 0 0 3900 0 0 40 h 40\n");
  const auto placed = read_log(folder / "b.clf");
  ASSERT_FALSE(placed.has_value());
  EXPECT_NE(placed.error().to_line().find("line 4, event 1: odometry moves 100.000 m"),
            std::string::npos)
      << placed.error().to_line();
}

}  // namespace
}  // namespace corridor::formats
