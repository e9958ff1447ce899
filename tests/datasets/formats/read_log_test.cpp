#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/log_io.hpp"
#include "datasets/formats/rawlog/rawlog.hpp"
#include "datasets/formats/trajectories/tum.hpp"
#include "tests/datasets/formats/formats_support.hpp"
#include "tests/datasets/formats/golden_support.hpp"

namespace corridor::formats {
namespace {

using test::ScratchFolder;
using test::small_log;
using test::write_text;

template <class T, class Change>
void change_nth(SensorLog& log, int n, Change change) {
  for (auto& event : log.events) {
    if (auto* reading = std::get_if<T>(&event); reading != nullptr && n-- == 0) change(*reading);
  }
}

bool notes_contain(const SensorLog& log, const std::string& part) {
  for (const std::string& note : log.provenance.notes) {
    if (note.find(part) != std::string::npos) return true;
  }
  return false;
}

TEST(ReadLog, ChoosesTheFormatByTheLongestKnownSuffix) {
  EXPECT_EQ(format_from_suffix("a.clf.gz"), LogFormat::kCarmen);
  EXPECT_EQ(format_from_suffix("dir.rawlog/a.log"), LogFormat::kCarmen);
  EXPECT_EQ(format_from_suffix("a.b.rawlog"), LogFormat::kRawlog);
  EXPECT_EQ(format_from_suffix("a.gz"), std::nullopt);
  EXPECT_EQ(sidecar_of("d/a.b.clf.gz", ".tum"), std::filesystem::path("d/a.b.tum"));
  EXPECT_EQ(sidecar_of("a.log", ".robot.toml"), std::filesystem::path("a.robot.toml"));
  const auto unknown = read_log("a.xyz");
  ASSERT_FALSE(unknown.has_value());
  EXPECT_EQ(unknown.error().code, ErrorCode::kUnsupported);
}

TEST(ReadLog, ListsSuffixesThatAreReadAndWritten) {
  EXPECT_EQ(writable_suffixes(), ".clf .clf.gz .log .log.gz .rawlog .rawlog.gz .bag");
  std::istringstream suffixes(readable_suffixes());
  std::string writable;
  for (std::string suffix; suffixes >> suffix;) {
    const auto format = format_from_suffix("a" + suffix);
    ASSERT_TRUE(format.has_value()) << suffix;
    EXPECT_EQ(sidecar_of("a" + suffix, ".tum"), std::filesystem::path("a.tum"));
    if (is_writable(*format)) writable += (writable.empty() ? "" : " ") + suffix;
  }
  EXPECT_EQ(writable, writable_suffixes());
}

TEST(ReadLog, KnowsTheOtherLogsThatASidecarBelongsTo) {
  const ScratchFolder folder;
  for (const char* name : {"a.clf", "a.tum", "a.b.clf", "ab.clf"}) write_text(folder / name, "x");
  EXPECT_TRUE(namesakes_of(folder / "a.clf").empty());
  EXPECT_EQ(namesakes_of(folder / "a.bag"), std::vector<std::filesystem::path>{folder / "a.clf"});
}

TEST(ReadLog, RefusesContentThatIsNotTheSuffixs) {
  const ScratchFolder folder;
  const auto line_of = [&folder](const std::string& name) {
    const auto read = read_log(folder / name);
    return read.has_value() ? "" : read.error().to_line();
  };
  const auto [robot, events] = test::golden_parts("lcm/data.lcm");
  for (const std::string name : {"a.clf", "a.rawlog", "a.bag", "a.dat"}) {
    write_text(folder / name, events);
    EXPECT_NE(line_of(name).find(name + ": the file begins as an LCM event log does; expected a "),
              std::string::npos)
        << line_of(name);
  }
  write_text(folder / "a.log", events);
  EXPECT_NE(line_of("a.log").find("nothing says what a tick of the wheels means"),
            std::string::npos);
}

// Before anybody looks for the calibration that a log of that kind would need.
TEST(ReadLog, TellsATextThatIsNoLogOfRawNumbersByItsFirstPlace) {
  const ScratchFolder folder;
  const std::string text = "ODOM 0 0 0 0 0 0 1 h 1\n";
  write_text(folder / "a.lcm", text);
  write_text(folder / "a.dat", text);
  const auto events = read_log(folder / "a.lcm");
  ASSERT_FALSE(events.has_value());
  EXPECT_NE(events.error().to_line().find("a.lcm: byte 0: "), std::string::npos)
      << events.error().to_line();
  const auto rows = read_log(folder / "a.dat");
  ASSERT_FALSE(rows.has_value());
  EXPECT_NE(rows.error().to_line().find("a.dat:1: 10 tokens; expected 707"), std::string::npos)
      << rows.error().to_line();
}

TEST(ReadLog, CountsRangesFromTheLimitOnInEveryFormat) {
  const ScratchFolder folder;
  SensorLog log = small_log();
  std::size_t num_beyond = 0;
  for (auto& event : log.events) {
    auto* scan = std::get_if<LaserScan>(&event);
    if (scan == nullptr) continue;
    for (std::size_t i = 0; i < 3; ++i, ++num_beyond) {
      scan->ranges_m[i] = static_cast<float>(scan->range_max_m) + 1;
      scan->is_valid[i] = 0;
    }
    scan->ranges_m[3] = 1;
    scan->is_valid[3] = 1;
    for (std::size_t i = 4; i < scan->num_beams(); ++i) {
      scan->ranges_m[i] = 0;
      scan->is_valid[i] = 0;
    }
  }
  for (const char* name : {"a.rawlog", "a.clf", "a.bag"}) {
    ASSERT_TRUE(write_log(log, folder / name));
    const auto read = read_log(folder / name);
    ASSERT_TRUE(read.has_value()) << read.error().to_line();
    EXPECT_TRUE(notes_contain(
        *read, std::to_string(num_beyond) + " beams at the LiDAR's limit or beyond taken as no"))
        << name;
    EXPECT_TRUE(notes_contain(*read, "16 beams of range 0 taken as no return")) << name;
  }
}

// Every defect written to a rawlog and read back: refused in one line that names the file.
TEST(ReadLog, RefusesEachDefectOfTheReadings) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const std::vector<std::pair<std::string, std::function<void(SensorLog&)>>> defects = {
      {"steps back",
       [](SensorLog& log) {
         change_nth<ImuSample>(log, 9, [](auto& s) { s.stamp.nanoseconds -= 40'000'000; });
       }},
      {"repeats",
       [](SensorLog& log) {
         change_nth<ImuSample>(log, 9, [](auto& s) { s.stamp.nanoseconds -= 10'000'000; });
       }},
      {"gap of",
       [](SensorLog& log) {
         change_nth<LaserScan>(log, 3, [](auto& s) { s.stamp.nanoseconds += 20'000'000'000; });
       }},
      {"valid with range nan",
       [kNan](SensorLog& log) {
         change_nth<LaserScan>(log, 1, [kNan](auto& s) { s.ranges_m[2] = kNan; });
       }},
      {"valid with range inf",
       [kInf](SensorLog& log) {
         change_nth<LaserScan>(log, 1, [kInf](auto& s) { s.ranges_m[2] = kInf; });
       }},
      {"valid with range -1",
       [](SensorLog& log) { change_nth<LaserScan>(log, 1, [](auto& s) { s.ranges_m[2] = -1; }); }},
      {"valid with range 0",
       [](SensorLog& log) { change_nth<LaserScan>(log, 1, [](auto& s) { s.ranges_m[2] = 0; }); }},
      {"scan of 7 beams",
       [](SensorLog& log) {
         change_nth<LaserScan>(log, 1, [](auto& s) {
           s.ranges_m.pop_back();
           s.is_valid.pop_back();
         });
       }},
      {"degrees per second",
       [](SensorLog& log) { change_nth<ImuSample>(log, 5, [](auto& s) { s.gyro_z_radps = 60; }); }},
      {"IMU reading is not finite",
       [](SensorLog& log) {
         change_nth<ImuSample>(log, 5, [](auto& s) { s.accel_x_mps2 = std::nan(""); });
       }},
      {"odometry moves",
       [](SensorLog& log) {
         change_nth<WheelSample>(log, 5, [](auto& s) { s.T_odom_base = Pose2(100, 0, 0); });
       }},
      {"no LiDAR scan",
       [](SensorLog& log) {
         std::erase_if(log.events, [](auto& e) { return std::holds_alternative<LaserScan>(e); });
       }},
      {"no events", [](SensorLog& log) { log.events.clear(); }},
      {"wheels.track_m", [](SensorLog& log) { log.robot.wheels.track_m = -1; }},
  };
  const ScratchFolder folder;
  for (const auto& [message, damage] : defects) {
    SensorLog log = small_log();
    damage(log);
    ASSERT_TRUE(write_rawlog(log, folder / "a.rawlog")) << message;
    const auto read = read_log(folder / "a.rawlog");
    ASSERT_FALSE(read.has_value()) << message;
    const std::string line = read.error().to_line();
    EXPECT_NE(line.find(message), std::string::npos) << line;
    EXPECT_NE(line.find("a.rawlog"), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

TEST(ReadLog, SecondsWrittenAsMillisecondsAreRefused) {
  const ScratchFolder folder;
  std::string text;
  for (int i = 0; i < 5; ++i) {
    text += "FLASER 2 1 1 0 0 0 0 0 0 " + std::to_string(100'000 * (i + 1)) + " h 0\n";
  }
  write_text(folder / "a.clf", text);
  const auto read = read_log(folder / "a.clf");
  ASSERT_FALSE(read.has_value());
  EXPECT_NE(read.error().to_line().find("gap of 100000.000 s"), std::string::npos);
}

TEST(ReadLog, RawRangesOfNoReturnsThatAreNotFiniteAreReplacedAndCounted) {
  const ScratchFolder folder;
  SensorLog log = small_log();
  change_nth<LaserScan>(log, 0, [](auto& scan) { scan.ranges_m[3] = std::nanf(""); });
  ASSERT_TRUE(write_rawlog(log, folder / "a.rawlog"));
  const auto read = read_log(folder / "a.rawlog");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  EXPECT_TRUE(notes_contain(*read, "1 raw ranges of beams without return"));
}

TEST(ReadLog, TakesTruthFromTheTumFileBesideIt) {
  const ScratchFolder folder;
  SensorLog log = small_log();
  log.truth.emplace();
  ASSERT_TRUE(log.truth->append({{100'000'000}, Pose2(1, 2, 0.5), {}}));
  ASSERT_TRUE(write_log(log, folder / "a.clf.gz"));
  const auto read = read_log(folder / "a.clf.gz");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  ASSERT_TRUE(read->truth.has_value());
  EXPECT_EQ((*read->truth)[0].T_map_base.x_m(), 1);
  write_text(folder / "a.tum", "broken\n");
  EXPECT_FALSE(read_log(folder / "a.clf.gz").has_value());
}

TEST(ReadLog, ASidecarOverridesTheLogKeyByKeyAndSaysSo) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_rawlog(small_log(), folder / "a.rawlog"));
  write_text(
      folder / "a.robot.toml",
      "[wheels]\ntrack_m = 0.5\n[lidar]\nx_m = 0.5\nrange_max_m = 1.5\nscan_duration_s = 0.05\n");
  const auto read = read_log(folder / "a.rawlog");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  EXPECT_EQ(read->robot.wheels.track_m, 0.5);
  EXPECT_EQ(read->robot.imu.T_base_imu, small_log().robot.imu.T_base_imu);
  EXPECT_TRUE(notes_contain(*read, "LiDAR placed at (0.5000 m"));
  EXPECT_TRUE(notes_contain(*read, "beams beyond the sidecar's 1.5 m"));
  for (const auto& event : read->events) {
    const auto* scan = std::get_if<LaserScan>(&event);
    if (scan == nullptr) continue;
    EXPECT_EQ(scan->T_base_lidar, Pose2(0.5, 0, 0));
    EXPECT_EQ(scan->duration_s, 0.05);
    EXPECT_EQ(scan->is_valid.back(), 0);  // 1.875 m and more
  }
  write_text(folder / "a.robot.toml", "[wheels]\ntrak_m = 0.5\n");
  EXPECT_NE(read_log(folder / "a.rawlog")
                .error()
                .to_line()
                .find("a.robot.toml:2: unknown key wheels.trak_m; expected one of track_m"),
            std::string::npos);
}

TEST(ReadLog, ARawlogsOwnModelThatIsWrongIsRefusedWithTheLineOfItsComment) {
  const ScratchFolder folder;
  std::string bytes = *rawlog_bytes(small_log());
  bytes.replace(bytes.find("track_m"), 7, "track_M");
  ASSERT_TRUE(write_file_atomically(folder / "a.rawlog", bytes));
  const auto read = read_log(folder / "a.rawlog");
  ASSERT_FALSE(read.has_value());
  const std::string where =
      (folder / "a.rawlog").string() + ": robot model in the leading comment:";
  EXPECT_EQ(read.error().to_line(),
            where + "4: wheels.track_m is missing; expected number; " + where +
                "5: unknown key wheels.track_M; expected one of track_m left_m_per_tick "
                "right_m_per_tick sigma_m_per_sqrt_m");
}

TEST(ReadLog, TheCallersModelFillsInForLogsThatCarryNone) {
  const ScratchFolder folder;
  write_text(folder / "a.clf", "FLASER 2 1 79 0 0 0 0 0 0 1.0 h 1.0\n");
  ReadLogOptions options;
  options.robot = RobotModel{};
  options.robot->lidar.T_base_lidar = Pose2(0.1, 0, 0);
  options.robot->wheels.track_m = 0.33;
  options.no_return_range_m = 50;
  const auto read = read_log(folder / "a.clf", options);
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  const auto& scan = std::get<LaserScan>(read->events[1]);
  EXPECT_EQ(scan.T_base_lidar, Pose2(0.1, 0, 0));
  EXPECT_EQ(scan.is_valid, (std::vector<std::uint8_t>{1, 0}));
  EXPECT_EQ(read->robot.lidar.range_max_m, 50);
  EXPECT_EQ(read->robot.wheels.track_m, 0.33);
}

TEST(ReadLog, AnUnwritableFolderIsAnErrorAndLeavesNothing) {
  const ScratchFolder folder;
  EXPECT_FALSE(write_log(small_log(), folder / "none" / "a.rawlog").has_value());
  EXPECT_FALSE(write_log(small_log(), folder / "a.xyz").has_value());
  SensorLog no_scans = small_log();
  no_scans.events.clear();
  EXPECT_FALSE(write_carmen(no_scans, folder / "a.clf").has_value());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace corridor::formats
