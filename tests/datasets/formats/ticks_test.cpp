#include "datasets/formats/ticks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/log_io.hpp"
#include "tests/datasets/formats/formats_support.hpp"

namespace corridor::formats {
namespace {

using test::ScratchFolder;
using test::write_text;

using Tokens = std::vector<std::string>;

RobotModel robot() {
  RobotModel robot;
  robot.wheels.track_m = 0.4;
  robot.wheels.left_m_per_tick = 1e-3;
  robot.wheels.right_m_per_tick = 1e-3;
  robot.lidar.range_max_m = 4;
  return robot;
}

// Range of beam i: 1000 + i mm.
Tokens row_tokens(int index) {
  Tokens tokens(707, "0");
  tokens[0] = std::to_string(361'000'000 + 100'000 * index);
  tokens[2] = std::to_string(5000 + 100 * index);
  tokens[3] = std::to_string(7000 + 100 * index);
  tokens[7] = "167.2";
  for (int i = 0; i < 682; ++i) {
    tokens[24 + static_cast<std::size_t>(i)] = std::to_string(1000 + i);
  }
  return tokens;
}

std::string row(const Tokens& tokens) {
  std::string line;
  for (const std::string& token : tokens) line += token + " ";
  return line + "\n";
}

std::string rows(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += row(row_tokens(i));
  return text;
}

TEST(Ticks, ARowIsAReadingOfTheWheelsAndAScan) {
  const auto log = parse_ticks(rows(3), "a.dat", robot(), RawClock::kData);
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  ASSERT_EQ(log->events.size(), 6U);
  const auto& wheels = std::get<WheelSample>(log->events[4]);
  EXPECT_EQ(wheels.stamp.nanoseconds, 361'200'000'000);
  EXPECT_EQ(wheels.ticks->left, 5200);
  EXPECT_EQ(wheels.ticks->right, 7200);
  EXPECT_NEAR(wheels.T_odom_base.x_m(), 0.2, 1e-12);
  EXPECT_EQ(stamp_of(log->events[5]), wheels.stamp);
  EXPECT_EQ(log->origins[5], 3U);
}

TEST(Ticks, BeamsCoverTheRangeInFrontCounterClockwiseFromTheRight) {
  const auto log = parse_ticks(rows(1), "a.dat", robot(), RawClock::kData);
  const auto& scan = std::get<LaserScan>(log->events[1]);
  ASSERT_EQ(scan.num_beams(), 543U);  // 70 to 612
  EXPECT_EQ(scan.ranges_m.front(), 1.070F);
  EXPECT_EQ(scan.ranges_m.back(), 1.612F);
  const double step_rad = 2 * std::acos(-1) / 1024;
  EXPECT_NEAR(scan.angle_rad(0), (70 - 340.5) * step_rad, 1e-12);
  EXPECT_NEAR(scan.angle_rad(542), (612 - 340.5) * step_rad, 1e-9);
}

TEST(Ticks, ZeroCodesAndTooLongRangesAreNoReturnAndCounted) {
  Tokens tokens = row_tokens(0);
  tokens[24 + 100] = "0";
  tokens[24 + 101] = "19";
  tokens[24 + 102] = "20";
  tokens[24 + 103] = "4000";
  tokens[24 + 104] = "4001";
  tokens[24 + 20] = "0";  // not among the beams that are used
  const auto log = parse_ticks(row(tokens), "a.dat", robot(), RawClock::kData);
  const auto& scan = std::get<LaserScan>(log->events[1]);
  EXPECT_EQ(scan.is_valid[30], 0);
  EXPECT_EQ(scan.is_valid[31], 0);
  EXPECT_EQ(scan.is_valid[32], 1);
  EXPECT_EQ(scan.is_valid[33], 1);
  EXPECT_EQ(scan.is_valid[34], 0);
  for (const auto& [what, count] : log->counts) EXPECT_EQ(count, 1U) << what;
  EXPECT_EQ(log->counts.size(), 3U);
}

TEST(Ticks, TheCalibratedOffsetMovesTheScansBeforeTheirRows) {
  RobotModel late = robot();
  late.lidar.time_offset_s = 0.15;
  const auto log = parse_ticks(rows(3), "a.dat", late, RawClock::kData);
  ASSERT_TRUE(log.has_value());
  EXPECT_EQ(stamp_of(log->events[0]).nanoseconds, 360'850'000'000);
  EXPECT_TRUE(std::holds_alternative<LaserScan>(log->events[0]));
  EXPECT_TRUE(std::holds_alternative<LaserScan>(log->events[1]));
  EXPECT_TRUE(std::holds_alternative<WheelSample>(log->events[2]));
  EXPECT_EQ(log->notes.size(), 1U);
}

// Rows that the program came to 20 ms late, every second of them.
std::string late_rows(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    Tokens tokens = row_tokens(i);
    if (i % 2 == 1) tokens[0] = std::to_string(361'000'000 + 100'000 * i + 20'000);
    text += row(tokens);
  }
  return text;
}

TEST(Ticks, AtAScanRateTheScansAreEvenAndTheWheelsKeepTheirStamps) {
  const auto log = parse_ticks(late_rows(101), "a.dat", robot(), RawClock::kScanRate);
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  Timestamp last;
  int num_scans = 0, num_wheels = 0;
  for (const SensorEvent& event : log->events) {
    if (std::holds_alternative<WheelSample>(event)) {
      const std::int64_t late_ns = num_wheels % 2 == 1 ? 20'000'000 : 0;
      EXPECT_EQ(stamp_of(event).nanoseconds,
                361'000'000'000 + 100'000'000LL * num_wheels + late_ns);
      ++num_wheels;
      continue;
    }
    if (num_scans > 0) {
      EXPECT_NEAR(seconds_between(last, stamp_of(event)), 0.1, 1e-8);
    }
    last = stamp_of(event);
    ++num_scans;
  }
  EXPECT_EQ(num_scans, 101);
  EXPECT_EQ(num_wheels, 101);
  ASSERT_EQ(log->notes.size(), 1U);
  EXPECT_EQ(log->notes[0],
            "scans put onto a constant rate of one in 0.10000 s, moved by 0.010 s at most");
}

TEST(Ticks, ARowFarOffTheScanRateIsRefusedWithItsLine) {
  std::string text = rows(30);
  Tokens late = row_tokens(30);
  late[0] = std::to_string(361'000'000 + 100'000 * 30 + 900'000);
  const auto log = parse_ticks(text + row(late), "a.dat", robot(), RawClock::kScanRate);
  ASSERT_FALSE(log.has_value());
  EXPECT_NE(log.error().to_line().find("a.dat:31"), std::string::npos) << log.error().to_line();
  EXPECT_NE(log.error().to_line().find("constant rate"), std::string::npos);
}

TEST(Ticks, AnswersEachDefectWithItsLine) {
  const auto damaged = [](const std::function<void(Tokens&)>& damage) {
    Tokens tokens = row_tokens(1);
    damage(tokens);
    return row(tokens);
  };
  const std::vector<std::pair<std::string, std::string>> defects = {
      {"\n", "0 tokens; expected 707"},
      {damaged([](auto& t) { t.pop_back(); }), "706 tokens"},
      {damaged([](auto& t) { t.emplace_back("1"); }), "more than 707 tokens"},
      {damaged([](auto& t) { t[0] = "12.5"; }), "stamp '12.5' (token 0)"},
      {damaged([](auto& t) { t[0] = "-1"; }), "stamp '-1'"},
      {damaged([](auto& t) { t[2] = "nan"; }), "left ticks 'nan' (token 2)"},
      {damaged([](auto& t) { t[3] = "9999999999999999999"; }), "right ticks"},
      {damaged([](auto& t) { t[94] = "-3"; }), "range '-3' (token 94)"},
      {damaged([](auto& t) { t[94] = "70000"; }), "range '70000'"},
      {damaged([](auto& t) { t[94] = "1,5"; }), "range '1,5'"},
      {std::string(100, '\x01') + "\n", "1 tokens"},
  };
  for (const auto& [line, message] : defects) {
    const auto log = parse_ticks(rows(1) + line, "a.dat", robot(), RawClock::kData);
    ASSERT_FALSE(log.has_value()) << message;
    const std::string text = log.error().to_line();
    EXPECT_NE(text.find("a.dat:2: "), std::string::npos) << text;
    EXPECT_NE(text.find(message), std::string::npos) << text;
    EXPECT_NE(text.find("; expected "), std::string::npos) << text;
  }
}

TEST(Ticks, ALineWithoutEndIsAnErrorNotAHang) {
  const auto log = parse_ticks(std::string(4'000'000, '1'), "a.dat", robot(), RawClock::kData);
  ASSERT_FALSE(log.has_value());
  EXPECT_LT(log.error().to_line().size(), 200U);
}

TEST(Ticks, AFileCutAnywhereIsAnErrorOrShorter) {
  const std::string text = rows(3);
  for (std::size_t length = 1; length < text.size() - 2; length += 97) {
    const auto log = parse_ticks(text.substr(0, length), "a.dat", robot(), RawClock::kData);
    if (log) {
      EXPECT_LT(log->events.size(), 6U) << length;
    }
  }
}

TEST(Ticks, ReadLogRefusesStepsBackJumpsAndTicksWithoutWheels) {
  const ScratchFolder folder;
  const auto read = [&folder](const std::function<void(Tokens&)>& damage) {
    Tokens last = row_tokens(5);
    damage(last);
    write_text(folder / "a.dat.gz", *gzip(rows(5) + row(last)));
    ReadLogOptions options;
    options.robot = robot();
    return read_log(folder / "a.dat.gz", options);
  };
  const auto good = read([](Tokens&) {});
  ASSERT_TRUE(good.has_value()) << good.error().to_line();
  EXPECT_EQ(good->provenance.format, "ticks");
  const auto back = read([](Tokens& t) { t[0] = "361000000"; });
  EXPECT_NE(back.error().to_line().find("line 6: stamp steps back"), std::string::npos);
  const auto repeated = read([](Tokens& t) { t[0] = "361400000"; });
  EXPECT_NE(repeated.error().to_line().find("stamp repeats"), std::string::npos);
  const auto gap = read([](Tokens& t) { t[0] = "461000000"; });
  EXPECT_NE(gap.error().to_line().find("gap of"), std::string::npos);
  const auto jump = read([](Tokens& t) { t[2] = "5000000"; });
  EXPECT_NE(jump.error().to_line().find("a.dat.gz:6: a wheel rolls"), std::string::npos);
  const auto without = read_log(folder / "a.dat.gz");
  EXPECT_NE(without.error().to_line().find("a.robot.toml"), std::string::npos);
  write_text(folder / "b.dat", "");
  EXPECT_FALSE(read_log(folder / "b.dat").has_value());
}

TEST(Ticks, ALimitThatNobodyStatesIsNoted) {
  const ScratchFolder folder;
  write_text(folder / "a.dat", rows(5));
  const std::string wheels =
      "[wheels]\ntrack_m = 0.4\nleft_m_per_tick = 1e-3\nright_m_per_tick = 1e-3\n";
  const auto says = [&folder](const std::string& robot_toml) {
    write_text(folder / "a.robot.toml", robot_toml);
    const auto read = read_log(folder / "a.dat");
    EXPECT_TRUE(read.has_value()) << read.error().to_line();
    const auto& notes = read->provenance.notes;
    return std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
      return note.find("tick logs state no limit: 30 m is assumed") == 0;
    });
  };
  EXPECT_TRUE(says(wheels));
  EXPECT_FALSE(says(wheels + "[lidar]\nrange_max_m = 4.0\n"));
}

}  // namespace
}  // namespace corridor::formats
