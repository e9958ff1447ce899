#include "datasets/formats/carmen/carmen.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/formats/log_io.hpp"
#include "tests/datasets/formats/formats_support.hpp"

namespace corridor::formats {
namespace {

using test::ScratchFolder;
using test::write_text;

const double kPi = std::acos(-1);

std::string flaser(int num_beams, const std::string& range, const std::string& tail) {
  std::string line = "FLASER " + std::to_string(num_beams);
  for (int i = 0; i < num_beams; ++i) line += " " + range;
  return line + " " + tail + "\n";
}

std::string robotlaser(const std::string& head, const std::string& ranges,
                       const std::string& tail) {
  return "ROBOTLASER1 0 " + head + " " + ranges + " 0 " + tail + "\n";
}

constexpr const char* kTail = "0 0 0 1 2 0.5 10.25 host 10.25";

Result<ParsedLog> parse(const std::string& text) {
  CarmenOptions options;
  options.flaser_range_max_m = 50;
  return parse_carmen(text, "a.clf", options);
}

const LaserScan& scan_of(const ParsedLog& log, std::size_t index) {
  return std::get<LaserScan>(log.events.at(index));
}

TEST(Carmen, FlaserGivesTheOdometryPoseThenTheScanOfTheSameStamp) {
  const auto log = parse("# comment\n" + flaser(4, "2.5", "9 9 3 1 2 0.5 10.25 host 99.0"));
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  ASSERT_EQ(log->events.size(), 2U);
  const auto& wheels = std::get<WheelSample>(log->events[0]);
  EXPECT_EQ(wheels.T_odom_base, Pose2(1, 2, 0.5));
  EXPECT_EQ(wheels.stamp.nanoseconds, 10'250'000'000);
  EXPECT_EQ(scan_of(*log, 1).stamp, wheels.stamp);
  EXPECT_EQ(log->origins[1], 2U);
}

TEST(Carmen, FlaserBeamsCoverHalfATurnFromTheRight) {
  const auto angles = [](int num_beams) {
    const auto log = parse(flaser(num_beams, "1", kTail));
    const LaserScan& scan = scan_of(*log, 1);
    return std::pair(scan.angle_rad(0), scan.angle_rad(scan.num_beams() - 1));
  };
  EXPECT_NEAR(angles(180).first, -kPi / 2, 1e-12);
  EXPECT_NEAR(angles(180).second, kPi / 2 - kPi / 180, 1e-12);  // i * 1 deg
  EXPECT_NEAR(angles(360).second, kPi / 2 - kPi / 360, 1e-12);  // i * 0.5 deg
  EXPECT_NEAR(angles(181).second, kPi / 2, 1e-12);
  EXPECT_NEAR(angles(361).second, kPi / 2, 1e-12);
}

TEST(Carmen, RangesAtTheLimitAreNoReturnAndKeepTheirRawValue) {
  const auto log = parse("FLASER 4 49.9 50 81.91 0 " + std::string(kTail) + "\n");
  const LaserScan& scan = scan_of(*log, 1);
  EXPECT_EQ(scan.is_valid, (std::vector<std::uint8_t>{1, 0, 0, 0}));
  EXPECT_EQ(scan.ranges_m, (std::vector<float>{49.9F, 50.0F, 81.91F, 0.0F}));
  EXPECT_EQ(log->counts.at("beams of range 0 taken as no return"), 1U);
  EXPECT_EQ(log->counts.at("beams at the LiDAR's limit or beyond taken as no return"), 2U);
}

TEST(Carmen, AByteOrderMarkIsSeenInTheMessageThatRefusesIt) {
  const auto log = parse("\xEF\xBB\xBF" + flaser(4, "2.5", kTail));
  ASSERT_FALSE(log.has_value());
  EXPECT_NE(log.error().to_line().find(R"(message '\xEF\xBB\xBFFLASER'; expected)"),
            std::string::npos)
      << log.error().to_line();
}

// One ROBOTLASER1 line of 2 beams with everything that the suite has no place for.
TEST(Carmen, WhatALineSaysAndTheLogDoesNotHoldIsCounted) {
  const auto full = parse(
      "ODOM 0 0 0 0.5 0 0.1 9 h 9\n"
      "ROBOTLASER1 4 -0.5 1 1 80 0.01 2 2 1 2 2 17 18 0 0 0 0 0 0 0 0.2 0.6 0.4 1 10 h 10.5\n"
      "FLASER 1 3 1 0 0 0 0 0 11 h 11\n");
  ASSERT_TRUE(full.has_value()) << full.error().to_line();
  const Counts expected = {{"FLASER lines lose their corrected pose", 1},
                           {"ODOM lines lose their acceleration", 1},
                           {"lines lose speeds (tv, rv) that are not those of their odometry", 2},
                           {"lines lose their host and the logger's stamp", 3},
                           {"scans lose the mode of their remissions", 1},
                           {"scans lose the robot's safety distances and turn axis", 1},
                           {"scans lose the type of their laser", 1},
                           {"scans lose their remissions", 1}};
  EXPECT_EQ(full->left_out, expected);
  const auto bare = parse("ODOM 0 0 0 0 0 0 9 corridor-bench 9\n");
  ASSERT_TRUE(bare.has_value());
  EXPECT_TRUE(bare->left_out.empty());
}

std::string log_of_accuracies(const std::vector<std::string>& accuracies) {
  std::string text;
  for (std::size_t i = 0; i < accuracies.size(); ++i) {
    const std::string stamp = std::to_string(i + 1);
    text += robotlaser("-0.5 1 1 80 " + accuracies[i] + " 0", "2 1 2",
                       "0 0 0 0 0 0 0 0 0 0 0 " + stamp + " h " + stamp);
  }
  return text;
}

TEST(Carmen, AConstantAccuracyIsTheLidarsNoiseAndIsWrittenBack) {
  const ScratchFolder folder;
  write_text(folder / "a.clf", log_of_accuracies({"0.035", "0.035"}));
  const auto read = read_log(folder / "a.clf");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  EXPECT_EQ(read->robot.lidar.range_sigma_m, 0.035);
  ASSERT_TRUE(write_carmen(*read, folder / "b.clf"));
  EXPECT_EQ(read_log(folder / "b.clf")->robot.lidar.range_sigma_m, 0.035);
}

TEST(Carmen, AnAccuracyThatIsNotTheModelsIsNoted) {
  const double assumed_m = RobotModel{}.lidar.range_sigma_m;
  const ScratchFolder folder;
  const auto expect_noted = [&](const std::string& note, double sigma_m) {
    const auto read = read_log(folder / "a.clf");
    ASSERT_TRUE(read.has_value()) << read.error().to_line();
    EXPECT_EQ(read->robot.lidar.range_sigma_m, sigma_m);
    const auto& notes = read->provenance.notes;
    EXPECT_NE(std::find(notes.begin(), notes.end(), note), notes.end()) << note;
    EXPECT_TRUE(read->provenance.has_left_out);
  };
  write_text(folder / "a.clf", log_of_accuracies({"0.035", "0.01"}));
  expect_noted("2 scans state accuracies that differ, not kept: range_sigma_m is 0.02 m",
               assumed_m);
  write_text(folder / "a.clf", log_of_accuracies({"0"}));
  expect_noted("1 scans state an accuracy of 0 m, not kept: range_sigma_m is 0.02 m", assumed_m);
  write_text(folder / "a.clf", log_of_accuracies({"0.035"}));
  write_text(folder / "a.robot.toml", "[lidar]\nrange_sigma_m = 0.05\n");
  expect_noted("1 scans state an accuracy of 0.035 m, not kept: range_sigma_m is 0.05 m", 0.05);
}

TEST(Carmen, SpeedsAreThoseOfTheOdometrySinceTheLineBefore) {
  const auto at = [](double stamp_s, const Pose2& T_odom_base) {
    return WheelSample{add_seconds(Timestamp{}, stamp_s), T_odom_base, std::nullopt};
  };
  const auto speeds =
      carmen_speeds({at(1, Pose2(0, 0, 0)), at(1.5, Pose2(0.25, 0, 0)), at(1.5, Pose2(0.25, 0, 0)),
                     at(2.5, Pose2(0.25, 0, 0.75)), at(2.6, Pose2(9, 0, 0.75))});
  const auto expect = [&](std::size_t line, double forward_mps, double turn_radps) {
    EXPECT_NEAR(speeds.at(line).forward_mps, forward_mps, 1e-12) << line;
    EXPECT_NEAR(speeds.at(line).turn_radps, turn_radps, 1e-12) << line;
  };
  expect(0, 0.5, 0);
  expect(1, 0.5, 0);
  expect(2, 0.5, 0);
  expect(3, 0, 0.75);
  expect(4, 0, 0.75);  // no robot is as fast: no speed
}

TEST(Carmen, WrittenSpeedsStayWhatTheyAreWhenTheLogIsWrittenAgain) {
  const ScratchFolder folder;
  SensorLog log = test::small_log();
  int num_samples = 0;
  for (auto& event : log.events) {
    auto* sample = std::get_if<WheelSample>(&event);
    if (sample == nullptr) continue;
    ++num_samples;
    sample->T_odom_base = Pose2(0.01 * num_samples, 0, 0.02 * num_samples);
  }
  ASSERT_TRUE(write_carmen(log, folder / "a.clf"));
  const std::string text = test::read_text(folder / "a.clf");
  EXPECT_EQ(text.find(" 0 0 0 0 0 0."), std::string::npos);
  const auto parsed = parse(text);
  ASSERT_TRUE(parsed.has_value()) << parsed.error().to_line();
  EXPECT_TRUE(parsed->left_out.empty()) << parsed->left_out.begin()->first;
}

TEST(Carmen, InfiniteRangesAreCountedNoReturns) {
  const auto log = parse("FLASER 2 inf 3 " + std::string(kTail) + "\n");
  const LaserScan& scan = scan_of(*log, 1);
  EXPECT_EQ(scan.is_valid, (std::vector<std::uint8_t>{0, 1}));
  EXPECT_EQ(scan.ranges_m[0], 51.0F);
  EXPECT_EQ(log->counts.size(), 1U);
}

TEST(Carmen, RobotlaserStatesItsGeometryAndItsMounting) {
  const auto log = parse(
      robotlaser("-0.5 1.5 0.5 8 0.01 0 4", "1 2 8 9", "2 1 1.5 2 1 1 0 0 0 0 0 3.5 host 3.5"));
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  const LaserScan& scan = scan_of(*log, 1);
  EXPECT_EQ(scan.angle_min_rad, -0.5);
  EXPECT_EQ(scan.angle_increment_rad, 0.5);
  EXPECT_EQ(scan.range_max_m, 8);
  EXPECT_EQ(scan.is_valid, (std::vector<std::uint8_t>{1, 1, 0, 0}));
  EXPECT_NEAR(scan.T_base_lidar.x_m(), 0, 1e-12);
  EXPECT_NEAR(scan.T_base_lidar.theta_rad(), 0.5, 1e-12);
  EXPECT_EQ(std::get<WheelSample>(log->events[0]).T_odom_base, Pose2(2, 1, 1));
}

TEST(Carmen, OdomLinesAreWheelSamplesAndOtherMessagesAreCounted) {
  const auto log = parse("PARAM odometry ODOM on 0 h 0\nODOM 1 2 3 0.1 0 0 5.5 h 5.5\n");
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  ASSERT_EQ(log->events.size(), 1U);
  EXPECT_EQ(std::get<WheelSample>(log->events[0]).T_odom_base, Pose2(1, 2, 3));
  EXPECT_EQ(log->left_out.at("PARAM lines skipped"), 1U);
}

TEST(Carmen, AnswersEachDefectWithItsLine) {
  const std::string tail = kTail;
  const std::vector<std::pair<std::string, std::string>> defects = {
      {"FLASER 4000000000 1 2 " + tail, "number of ranges '4000000000'"},
      {"FLASER -1 " + tail, "number of ranges '-1'"},
      {"FLASER 0 " + tail, "number of ranges '0'"},
      {"FLASER", "number of ranges missing"},
      {"FLASER 2 1 nan " + tail, "range 'nan'"},
      {"FLASER 2 1 -3 " + tail, "range '-3'"},
      {"FLASER 2 1 1,5 " + tail, "range '1,5'"},
      {"FLASER 2 1 2 3 " + tail, "logger stamp 'host'"},  // a range too many shifts all the rest
      {"FLASER 3 1 2 " + tail, "stamp 'host'"},           // one too few
      {"FLASER 2 1 2 0 0 0 1 2", "odometry pose missing"},
      {"FLASER 2 1 2 0 0 0 1 2 nan 1 h 1", "odometry pose 'nan'"},
      {"FLASER 2 1 2 0 0 0 1 2 0 1e3 h 1", "stamp '1e3'"},
      {"FLASER 2 1 2 0 0 0 1 2 0 1 h", "logger stamp missing"},
      {"FLASER 2 1 2 0 0 0 1 2 0 1 h 1 more", "field 'more'"},
      {"ROBOTLASER1 0 -1 2 0.5 8 0.01 0 6 1 1 1 1 1 1 0 0 0 0 0 0 0 0 0 0 0 0 1 h 1",
       "number of ranges '6'"},
      {"ROBOTLASER1 0 -1 2 0 8 0.01 0 4 1 1 1 1 0 0 0 0 0 0 0 0 0 0 0 0 1 h 1",
       "number of ranges '4'"},
      {"ROBOTLASER1 0 -1 1.5 0.5 -8 0.01 0 4 1 1 1 1 0 0 0 0 0 0 0 0 0 0 0 0 1 h 1",
       "maximum range '-8'"},
      {"ODOM 1 2 3 0 0 0 x h 1", "stamp 'x'"},
      {"PARAM width 0.5 0 h 0;ODOM 1 2 3 0 0 0 1 h 1", "ODOM within a line"},
      {"SYNC a 1 h 1 FLASER 1 1 " + tail, "FLASER within a line"},
      {"\x01\x02garbage", "message '\\x01\\x02garbage'"},
  };
  for (const auto& [line, message] : defects) {
    const auto log = parse(flaser(2, "1", kTail) + line + "\n");
    ASSERT_FALSE(log.has_value()) << line;
    const std::string text = log.error().to_line();
    EXPECT_NE(text.find("a.clf:2: "), std::string::npos) << text;
    EXPECT_NE(text.find(message), std::string::npos) << text;
    EXPECT_NE(text.find("; expected "), std::string::npos) << text;
  }
}

TEST(Carmen, ALineWithoutEndIsAnErrorNotAHang) {
  const auto log = parse("FLASER 180 " + std::string(2'000'000, '1'));
  ASSERT_FALSE(log.has_value());
  EXPECT_LT(log.error().to_line().size(), 200U);
}

TEST(Carmen, ReadUndoesWriteForWhatTheFormatHolds) {
  const ScratchFolder folder;
  SensorLog log = test::small_log();
  for (const std::string name : {"a.clf", "a.clf.gz"}) {
    ASSERT_TRUE(write_carmen(log, folder / name));
    const auto read = read_log(folder / name);
    ASSERT_TRUE(read.has_value()) << read.error().to_line();
    EXPECT_EQ(read->num_scans(), log.num_scans());
    EXPECT_EQ(read->num_wheel_samples(), log.num_wheel_samples());
    EXPECT_EQ(read->num_imu_samples(), 0U);
    // Writing what was read gives the same bytes but for the mounting's last digits.
    ASSERT_TRUE(write_carmen(*read, folder / "b.clf"));
    const auto again = read_log(folder / "b.clf");
    ASSERT_TRUE(again.has_value());
    for (std::size_t i = 0; i < read->events.size(); ++i) {
      const auto* a = std::get_if<LaserScan>(&read->events[i]);
      if (a == nullptr) continue;
      const auto& b = std::get<LaserScan>(again->events[i]);
      EXPECT_EQ(a->ranges_m, b.ranges_m);
      EXPECT_EQ(a->is_valid, b.is_valid);
      EXPECT_EQ(a->angle_min_rad, b.angle_min_rad);
      EXPECT_NEAR(a->T_base_lidar.x_m(), 0.25, 1e-12);
    }
  }
}

TEST(Carmen, FilesTruncatedAtEvery97thByteAreErrorsShorterOrNoted) {
  const ScratchFolder folder;
  const SensorLog log = test::small_log();
  ASSERT_TRUE(write_carmen(log, folder / "whole.clf"));
  const std::string text = test::read_text(folder / "whole.clf");
  const std::size_t num_events = read_log(folder / "whole.clf")->events.size();
  for (std::size_t length = 0; length < text.size() - 1; length += 97) {
    write_text(folder / "a.clf", text.substr(0, length));
    const auto read = read_log(folder / "a.clf");
    if (!read) continue;
    const auto& notes = read->provenance.notes;
    const bool is_noted = std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
      return note.find("the last line has no end") != std::string::npos;
    });
    EXPECT_TRUE(read->events.size() < num_events || is_noted) << "cut at byte " << length;
  }
}

TEST(Carmen, LossesNameWhatTheFormatCannotHold) {
  const auto losses = losses_of_conversion(test::small_log(), LogFormat::kCarmen);
  const auto has = [&losses](const std::string& line) {
    return std::find(losses.begin(), losses.end(), line) != losses.end();
  };
  EXPECT_TRUE(has("41 IMU readings are left out"));
  EXPECT_TRUE(has("9 wheel samples lose their encoder ticks"));
}

TEST(Carmen, AStepBackIsAnErrorUnlessTheOrderIsThatOfTheFile) {
  const ScratchFolder folder;
  write_text(folder / "a.clf", flaser(2, "1", "0 0 0 0 0 0 2.0 h 2.0") +
                                   flaser(2, "1", "0 0 0 0 0 0 1.9 h 1.9") +
                                   flaser(2, "1", "0 0 0 0 0 0 3.0 h 3.0"));
  const auto refused = read_log(folder / "a.clf");
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().to_line().find("line 2: stamp steps back by 0.100000 s"),
            std::string::npos);
  ReadLogOptions options;
  options.order = StampOrder::kFile;
  const auto kept = read_log(folder / "a.clf", options);
  ASSERT_TRUE(kept.has_value()) << kept.error().to_line();
  EXPECT_NE(kept->provenance.notes.at(0).find("FLASER lines state no limit: 81 m is assumed"),
            std::string::npos);
  EXPECT_NE(kept->provenance.notes.at(1).find("2 rows' stamps moved"), std::string::npos);
  EXPECT_EQ(stamp_of(kept->events[2]).nanoseconds - stamp_of(kept->events[0]).nanoseconds, 1000);
}

}  // namespace
}  // namespace corridor::formats
