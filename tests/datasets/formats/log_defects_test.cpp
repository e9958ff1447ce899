// One defect of a drive, as it stands in the file, in every log format that can have it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "datasets/formats/log_health.hpp"
#include "datasets/formats/log_io.hpp"
#include "slam/core/units.hpp"
#include "tests/datasets/formats/formats_support.hpp"
#include "tests/datasets/formats/lcm_support.hpp"
#include "tests/datasets/formats/text_formats.hpp"

namespace corridor::formats {
namespace {

using test::joined;
using test::ScratchFolder;
using test::write_text;

constexpr double kTurn_rad = 360 * kRadPerDeg;
constexpr int kNumSteps = 300;
constexpr double kStep_s = 0.1;
constexpr double kSpeed_mps = 0.4;
constexpr double kYawRate_radps = 0.06;
constexpr double kTrack_m = 0.1;
constexpr double kMetresPerTick = 1e-4;
constexpr double kRangeLimit_m = 4;
constexpr int kNumBeams = 40;
constexpr std::size_t kBadBeam = 30;

// What is wrong with a drive: factors of 1 and no gap are none.
struct Faults {
  double range_factor = 1;
  double fan_factor = 1;
  double heading_factor = 1;
  double gyro_factor = 1;
  double gap_s = 0;                               // from 10 s on no scan
  std::optional<float> bad_range = std::nullopt;  // of one beam of every scan
};

// A drive on an arc for 30 s, as the numbers stand in a file: nothing is wrapped.
struct Step {
  double time_s = 0;
  double x_m = 0, y_m = 0, heading_rad = 0;
  double gyro_radps = 0;
  WheelTicks ticks;
  std::vector<float> ranges_m;  // empty: lost

  [[nodiscard]] Timestamp stamp() const { return timestamp_from_seconds(100 + time_s); }
};

struct Drive {
  std::vector<Step> steps;
  double angle_min_rad = 0, angle_increment_rad = 0, range_max_m = 0;
};

std::vector<float> ranges_of(int step, const Faults& faults) {
  std::vector<float> ranges_m;
  for (int beam = 0; beam < kNumBeams; ++beam) {
    const double range_m = 1.3 + 0.01 * beam + 0.001 * step;
    ranges_m.push_back(static_cast<float>(range_m * faults.range_factor));
  }
  if (faults.bad_range) ranges_m[kBadBeam] = *faults.bad_range;
  return ranges_m;
}

Drive drive_with(const Faults& faults) {
  Drive drive;
  drive.angle_increment_rad = kTurn_rad / kNumBeams * faults.fan_factor;
  drive.angle_min_rad = -0.5 * (kNumBeams - 1) * drive.angle_increment_rad;
  drive.range_max_m = kRangeLimit_m * faults.range_factor;
  for (int i = 0; i < kNumSteps; ++i) {
    Step step;
    step.time_s = kStep_s * i;
    const double turn_rad = kYawRate_radps * step.time_s;
    step.x_m = kSpeed_mps / kYawRate_radps * std::sin(turn_rad);
    step.y_m = kSpeed_mps / kYawRate_radps * (1 - std::cos(turn_rad));
    step.heading_rad = turn_rad * faults.heading_factor;
    step.gyro_radps = kYawRate_radps * faults.gyro_factor;
    const auto ticks = [&](double side) {
      return std::llround((kSpeed_mps * step.time_s + side * 0.5 * kTrack_m * turn_rad) /
                          kMetresPerTick);
    };
    step.ticks = {ticks(-1), ticks(1)};
    const bool is_lost = step.time_s > 10 && step.time_s < 10 + faults.gap_s;
    if (!is_lost) step.ranges_m = ranges_of(i, faults);
    drive.steps.push_back(step);
  }
  return drive;
}

SensorLog log_of(const Drive& drive) {
  SensorLog log;
  log.robot.wheels = {
      .track_m = kTrack_m, .left_m_per_tick = kMetresPerTick, .right_m_per_tick = kMetresPerTick};
  log.robot.lidar.range_max_m = drive.range_max_m;
  log.robot.imu.rate_hz = 1 / kStep_s;
  for (const Step& step : drive.steps) {
    log.events.emplace_back(ImuSample{step.stamp(), step.gyro_radps, 0, 0});
    log.events.emplace_back(
        WheelSample{step.stamp(), Pose2(step.x_m, step.y_m, step.heading_rad), step.ticks});
    if (step.ranges_m.empty()) continue;
    LaserScan scan;
    scan.stamp = step.stamp();
    scan.angle_min_rad = drive.angle_min_rad;
    scan.angle_increment_rad = drive.angle_increment_rad;
    scan.range_max_m = drive.range_max_m;
    scan.ranges_m = step.ranges_m;
    scan.is_valid.assign(step.ranges_m.size(), 1);
    log.events.emplace_back(std::move(scan));
  }
  return log;
}

// Text of our own: a written SensorLog's headings are wrapped.
std::string carmen_of(const Drive& drive) {
  std::string text;
  for (const Step& step : drive.steps) {
    const std::string pose = fmt::format("{} {} {}", step.x_m, step.y_m, step.heading_rad);
    const std::string end =
        fmt::format("{:.6f} host {:.6f}\n", 100 + step.time_s, 100 + step.time_s);
    if (step.ranges_m.empty()) {
      text += fmt::format("ODOM {} {} {} 0 {}", pose, kSpeed_mps, kYawRate_radps, end);
      continue;
    }
    text += fmt::format("ROBOTLASER1 0 {} {} {} {} 0.01 0 {}", drive.angle_min_rad,
                        drive.angle_increment_rad * kNumBeams, drive.angle_increment_rad,
                        drive.range_max_m, kNumBeams);
    for (const float range_m : step.ranges_m) text += fmt::format(" {}", range_m);
    text += fmt::format(" 0 {} {} {} {} 0 0 0 {}", pose, pose, kSpeed_mps, kYawRate_radps, end);
  }
  return text;
}

std::string lcm_of(const Drive& drive) {
  constexpr double kLsbPerDps = 131;
  test::LcmLog log;
  for (const Step& step : drive.steps) {
    const std::int64_t now_us = step.stamp().nanoseconds / 1000;
    log.add(now_us, "MAEBOT_MOTOR_FEEDBACK",
            test::ticks_message(now_us, static_cast<std::int32_t>(step.ticks.left),
                                static_cast<std::int32_t>(step.ticks.right)));
    const double gyro_lsb = step.gyro_radps * kDegPerRad * kLsbPerDps;
    log.add(now_us, "MAEBOT_SENSOR_DATA",
            test::imu_message(now_us, 0, 0, static_cast<std::int16_t>(std::lround(gyro_lsb))));
    if (step.ranges_m.empty()) continue;
    test::ScanBeams beams = test::regular_beams(now_us, kNumBeams);
    const double fan_factor = drive.angle_increment_rad * kNumBeams / (kTurn_rad);
    for (float& angle_rad : beams.angles_rad) angle_rad *= static_cast<float>(fan_factor);
    beams.ranges_m = step.ranges_m;
    log.add(now_us + 1000 * kNumBeams, "MAEBOT_LASER_SCAN", test::scan_message(now_us, beams));
  }
  return log.bytes();
}

// All of 682 ranges: those of the drive over and over. A row without scan is lost as a whole.
std::string ticks_of(const Drive& drive) {
  std::string text;
  for (const Step& step : drive.steps) {
    if (step.ranges_m.empty()) continue;
    text += fmt::format("{} 0 {} {}", step.stamp().nanoseconds / 1000, step.ticks.left,
                        step.ticks.right);
    for (int token = 4; token < 24; ++token) text += " 0";
    for (std::size_t i = 0; i < 682; ++i) {
      const float range_m = step.ranges_m[i % step.ranges_m.size()];
      text +=
          fmt::format(" {}", std::isfinite(range_m) ? std::to_string(std::lround(1000 * range_m))
                                                    : fmt::format("{}", range_m));
    }
    text += " 0\n";
  }
  return text;
}

// What reading a log says: the Error, or notes and suspicions.
struct Said {
  bool is_read = false;
  std::string text;

  [[nodiscard]] bool has(const std::string& part) const {
    return text.find(part) != std::string::npos;
  }
};

using Write = std::function<void(const Drive& drive, const std::filesystem::path& path)>;

struct Format {
  std::string file;
  Write write;
};

Write written_by(std::string (*text_of)(const Drive&)) {
  return [text_of](const Drive& drive, const std::filesystem::path& path) {
    write_text(path, text_of(drive));
  };
}

void write_as_log(const Drive& drive, const std::filesystem::path& path) {
  const auto written = write_log(log_of(drive), path);
  ASSERT_TRUE(written.has_value()) << written.error().to_line();
}

std::vector<Format> formats() {
  return {{"a.clf", written_by(carmen_of)},
          {"a.rawlog", write_as_log},
          {"a.bag", write_as_log},
          {"a.lcm", written_by(lcm_of)},
          {"a.dat", written_by(ticks_of)}};
}

Format format_of(const std::string& file) {
  const std::vector<Format> all = formats();
  return *std::find_if(all.begin(), all.end(), [&](const Format& f) { return f.file == file; });
}

Said read_back(const Format& format, const Faults& faults) {
  const ScratchFolder folder;
  const Drive drive = drive_with(faults);
  write_text(folder / "a.robot.toml",
             fmt::format("[wheels]\ntrack_m = {}\nleft_m_per_tick = {}\nright_m_per_tick = {}\n"
                         "[lidar]\nrange_max_m = {}\n[imu]\nrate_hz = 10\n",
                         kTrack_m, kMetresPerTick, kMetresPerTick, drive.range_max_m));
  format.write(drive, folder / format.file);
  const auto log = read_log(folder / format.file);
  if (!log) return {false, log.error().to_line()};
  return {true, joined(log->provenance.notes) + joined(examine(*log).suspicions)};
}

TEST(LogDefects, ASoundDriveIsNotSuspiciousInAnyFormat) {
  for (const Format& format : formats()) {
    const Said said = read_back(format, {});
    EXPECT_TRUE(said.is_read) << said.text;
    EXPECT_FALSE(said.has("?")) << format.file << ": " << said.text;
  }
}

// What a log of each format says of a defect; formats that are not named cannot have it.
struct Expected {
  std::string file;
  std::string part;
};

void expect_said(const Faults& faults, bool is_read, const std::vector<Expected>& expected) {
  for (const Expected& one : expected) {
    const Said said = read_back(format_of(one.file), faults);
    EXPECT_EQ(said.is_read, is_read) << one.file << ": " << said.text;
    EXPECT_TRUE(said.has(one.part)) << one.file << ": " << said.text;
  }
}

TEST(LogDefects, RangesInCentimetresAreSuspiciousOrRefusedInEveryFormat) {
  const Faults faults{.range_factor = 100};
  const std::string suspicion = "centimetres or millimetres for metres?";
  expect_said(
      faults, true,
      {{"a.clf", suspicion}, {"a.rawlog", suspicion}, {"a.bag", suspicion}, {"a.lcm", suspicion}});
  expect_said(faults, false, {{"a.dat", "range '130000' (token 24)"}});
}

// Ticks state no angle.
TEST(LogDefects, AFanInDegreesIsRefused) {
  expect_said({.fan_factor = kDegPerRad}, false,
              {{"a.clf", "expected at most 2 pi (degrees for radians?)"},
               {"a.rawlog", "scan with aperture 351 rad; expected 0 to 2 pi"},
               {"a.bag", "expected a fan of at most 2 pi (degrees for radians?)"},
               {"a.lcm", "beam 1 points to 9 rad; expected an angle within one turn of 0"}});
}

// LCM logs and ticks state no heading. A rawlog's and a bag's are wrapped: what is left to see is
// that they do not go with the way, and with the gyro.
TEST(LogDefects, HeadingsInDegreesAreSuspicious) {
  const Faults faults{.heading_factor = kDegPerRad};
  const std::string way = "wheels: 64 % of the way lies across the headings; degrees for radians";
  const std::string gyro = "IMU: the gyro turns 0.02 times as far as the wheels";
  expect_said(faults, true, {{"a.clf", way}, {"a.rawlog", way}, {"a.bag", way}});
  expect_said(faults, true, {{"a.rawlog", gyro}, {"a.bag", gyro}});
  expect_said(faults, true, {{"a.clf", "562 of 600 angles are beyond 2 pi: degrees for radians?"}});
}

// CARMEN logs and ticks have no IMU.
TEST(LogDefects, GyroRatesInDegreesAreSuspicious) {
  const std::string suspicion = " times as far as the wheels; its rates in degrees per second?";
  expect_said({.gyro_factor = kDegPerRad}, true,
              {{"a.rawlog", "57.30" + suspicion},
               {"a.bag", "57.30" + suspicion},
               {"a.lcm", "57.27" + suspicion}});  // whole numbers of the gyro
}

TEST(LogDefects, LostScansAreAGapThatIsSuspiciousOrRefusedInEveryFormat) {
  for (const Format& format : formats()) {
    expect_said({.gap_s = 5}, true, {{format.file, "LiDAR: no reading for 5.000 s before event"}});
    const bool are_rows_lost = format.file == "a.dat";  // with their ticks
    expect_said({.gap_s = 12}, false,
                {{format.file, are_rows_lost ? "gap of 12.000 s between two wheel samples"
                                             : "gap of 12.000 s between two scans"}});
  }
}

TEST(LogDefects, InfiniteRangesAreRefusedOrCountedAsNoReturnInEveryFormat) {
  const Faults faults{.bad_range = std::numeric_limits<float>::infinity()};
  expect_said(faults, true,
              {{"a.clf", "300 infinite ranges replaced by the sensor's limit + 1 m, as no return"},
               {"a.bag", "300 infinite ranges taken as no return, replaced by the limit + 1 m"},
               {"a.lcm", "300 beams of infinite range taken as no return"}});
  expect_said(faults, false,
              {{"a.rawlog", "beam 30 is marked valid with range inf m; expected (0, 4] m"},
               {"a.dat", "range 'inf' (token 54)"}});
}

// Of the LCM robot they are what its driver makes of ranges it cannot say.
TEST(LogDefects, NegativeRangesAreRefusedOrCountedAsNoReturnInEveryFormat) {
  const Faults faults{.bad_range = -1.5F};
  expect_said(faults, true, {{"a.lcm", "300 beams of negative range taken as no return"}});
  expect_said(faults, false,
              {{"a.clf", "range '-1.5'; expected a number >= 0"},
               {"a.rawlog", "beam 30 is marked valid with range -1.5 m; expected (0, 4] m"},
               {"a.bag", "range -1.5 m of beam 30; expected a range >= 0"},
               {"a.dat", "range '-1500' (token 54)"}});
}

TEST(LogDefects, RangesThatAreNotANumberAreRefusedOrCountedAsNoReturnInEveryFormat) {
  const Faults faults{.bad_range = std::numeric_limits<float>::quiet_NaN()};
  expect_said(faults, true,
              {{"a.bag", "300 NaN ranges taken as no return, replaced by the limit + 1 m"}});
  expect_said(faults, false,
              {{"a.clf", "range 'nan'; expected a number >= 0"},
               {"a.rawlog", "beam 30 is marked valid with range nan m; expected (0, 4] m"},
               {"a.lcm", "beam 30 has the range nan; expected a number"},
               {"a.dat", "range 'nan' (token 54)"}});
}

}  // namespace
}  // namespace corridor::formats
