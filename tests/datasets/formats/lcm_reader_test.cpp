#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/lcm/lcm.hpp"
#include "datasets/formats/log_io.hpp"
#include "slam/core/rng.hpp"
#include "tests/datasets/formats/formats_support.hpp"
#include "tests/datasets/formats/lcm_support.hpp"

namespace corridor::formats {
namespace {

using test::LcmLog;
using test::ScanBeams;
using test::ScratchFolder;
using test::small_lcm_log;
using test::write_text;

const double kPi = std::acos(-1);
constexpr std::int64_t kBegin_us = 100'000'000;

LcmOptions options_with(RawClock clock = RawClock::kData) {
  LcmOptions options;
  options.raw.clock = clock;
  options.raw.gyro_lsb_per_dps = 131;
  options.robot.wheels.left_m_per_tick = 1e-4;
  options.robot.wheels.right_m_per_tick = 1e-4;
  options.robot.lidar.range_max_m = 8;
  return options;
}

Result<ParsedLog> parse(const LcmLog& log, const LcmOptions& options = options_with()) {
  return parse_lcm(log.bytes(), "a.lcm", options);
}

template <class T>
std::vector<T> all_of(const ParsedLog& log) {
  std::vector<T> found;
  for (const SensorEvent& event : log.events) {
    if (const auto* reading = std::get_if<T>(&event)) found.push_back(*reading);
  }
  return found;
}

bool notes_contain(const SensorLog& log, const std::string& part) {
  for (const std::string& note : log.provenance.notes) {
    if (note.find(part) != std::string::npos) return true;
  }
  return false;
}

TEST(LcmReader, GivesScansWheelsAndImuInOrderOfTheirStamps) {
  const auto log = parse(small_lcm_log());
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  EXPECT_EQ(all_of<LaserScan>(*log).size(), 10U);
  EXPECT_EQ(all_of<WheelSample>(*log).size(), 20U);
  EXPECT_EQ(all_of<ImuSample>(*log).size(), 20U);
  for (std::size_t i = 1; i < log->events.size(); ++i) {
    EXPECT_LE(stamp_of(log->events[i - 1]), stamp_of(log->events[i]));
  }
  EXPECT_EQ(log->origin_unit, "byte");
}

TEST(LcmReader, ClockwiseAnglesPointToTheRightAndBeamZeroIsTheLastTaken) {
  const auto scan = all_of<LaserScan>(*parse(small_lcm_log())).front();
  ASSERT_EQ(scan.num_beams(), 40U);
  EXPECT_EQ(scan.stamp.nanoseconds, (kBegin_us + 39'000) * 1000);
  EXPECT_NEAR(scan.duration_s, -0.039, 1e-6);
  // The tenth of 40 beams is a quarter turn clockwise: right of the robot.
  EXPECT_EQ(scan.ranges_m[29], 1.1F);
  EXPECT_NEAR(wrap_angle(scan.angle_rad(29) + kPi / 2), 0, 1e-6);
  LcmOptions options = options_with();
  options.raw.is_lidar_clockwise = false;
  const auto mirrored = all_of<LaserScan>(*parse(small_lcm_log(), options)).front();
  EXPECT_EQ(mirrored.ranges_m[10], 1.1F);
  EXPECT_NEAR(wrap_angle(mirrored.angle_rad(10) - kPi / 2), 0, 1e-6);
  EXPECT_GT(mirrored.duration_s, 0);
}

TEST(LcmReader, TurnsRawNumbersIntoUnits) {
  const auto log = parse(small_lcm_log());
  const ImuSample imu = all_of<ImuSample>(*log).front();
  EXPECT_NEAR(imu.accel_x_mps2, 1638.0 / 16384 * 9.80665, 1e-12);
  EXPECT_NEAR(imu.accel_y_mps2, -1638.0 / 16384 * 9.80665, 1e-12);
  EXPECT_NEAR(imu.gyro_z_radps, kPi / 180, 1e-12);
  const WheelSample wheels = all_of<WheelSample>(*log).back();
  EXPECT_NEAR(wheels.T_odom_base.x_m(), 0.19, 1e-12);
  EXPECT_EQ(wheels.ticks->left, 1900);
}

TEST(LcmReader, SensorsOnTwoClocksAreRefusedUnlessTheRuleIsStated) {
  const LcmLog apart = small_lcm_log(-50'000'000);
  const auto refused = parse(apart);
  ASSERT_FALSE(refused.has_value());
  const std::string line = refused.error().to_line();
  EXPECT_NE(line.find("clock of the wheels is 50.000 s behind the LiDAR's"), std::string::npos)
      << line;
  EXPECT_NE(line.find("event-offset"), std::string::npos) << line;
  const auto moved = parse(apart, options_with(RawClock::kEventOffset));
  ASSERT_TRUE(moved.has_value()) << moved.error().to_line();
  // Late by the delay of all messages, which their times cannot tell.
  EXPECT_EQ(all_of<WheelSample>(*moved).front().stamp.nanoseconds, (kBegin_us + 500) * 1000);
  EXPECT_EQ(all_of<ImuSample>(*moved).back().stamp.nanoseconds, (kBegin_us + 950'000 + 500) * 1000);
  EXPECT_NE(moved->notes.at(0).find("stamps of the wheels moved onto the LiDAR's clock"),
            std::string::npos);
}

TEST(LcmReader, ReferencePosesWithBrokenStampsAreLeftOutAndCounted) {
  LcmLog log = small_lcm_log();
  log.add(kBegin_us, "MAEBOT_POSE", test::pose_message(139'736'737'237'464, 0, 0, 0));
  log.add(kBegin_us, "MAEBOT_POSE", test::pose_message(kBegin_us, 1, 2, 0.5F));
  log.add(kBegin_us, "MAEBOT_POSE", test::pose_message(kBegin_us, 3, 2, 0.5F));
  const auto parsed = parse(log);
  ASSERT_TRUE(parsed.has_value()) << parsed.error().to_line();
  ASSERT_EQ(parsed->reference->size(), 1U);
  EXPECT_EQ((*parsed->reference)[0].T_map_base, Pose2(1, 2, 0.5));
  EXPECT_EQ(
      parsed->left_out.at("reference poses with a stamp outside the log or out of order left out"),
      2U);
}

TEST(LcmReader, RangesThatAreNoReturnAreCountedByKind) {
  const std::int64_t now_us = kBegin_us + 2'000'000;
  ScanBeams beams = test::regular_beams(now_us);
  beams.ranges_m[1] = 0;
  beams.ranges_m[2] = -8.189F;
  beams.ranges_m[3] = std::numeric_limits<float>::infinity();
  beams.ranges_m[4] = 8.5F;
  LcmLog log = small_lcm_log();
  log.add(now_us, "MAEBOT_LASER_SCAN", test::scan_message(now_us, beams));
  const auto parsed = parse(log);
  ASSERT_TRUE(parsed.has_value()) << parsed.error().to_line();
  const LaserScan scan = all_of<LaserScan>(*parsed).back();
  EXPECT_EQ(std::count(scan.is_valid.begin(), scan.is_valid.end(), 0), 4);
  for (const char* kind :
       {"beams of range 0 taken as no return", "beams of negative range taken as no return",
        "beams of infinite range taken as no return",
        "beams at the LiDAR's limit or beyond taken as no return"}) {
    EXPECT_EQ(parsed->counts.at(kind), 1U) << kind;
  }
}

TEST(LcmReader, OtherChannelsAndASecondLidarAreLeftOutAndCounted) {
  LcmLog log = small_lcm_log();
  log.add(kBegin_us, "LCM_SELF_TEST", "lcm self test");
  log.add(kBegin_us, "OTHER_LASER_SCAN",
          test::scan_message(kBegin_us, test::regular_beams(kBegin_us)));
  const auto parsed = parse(log);
  ASSERT_TRUE(parsed.has_value()) << parsed.error().to_line();
  EXPECT_EQ(parsed->left_out.at("messages on channels of no use left out"), 1U);
  EXPECT_EQ(parsed->left_out.at("scans of a second LiDAR left out"), 1U);
}

// One broken message at the end of a good log: refused in one line with the message's byte.
TEST(LcmReader, AnswersEachDefectWithItsByte) {
  const std::int64_t now_us = kBegin_us + 2'000'000;
  const auto scan = [now_us](const std::function<void(ScanBeams&)>& damage) {
    ScanBeams beams = test::regular_beams(now_us);
    damage(beams);
    return test::scan_message(now_us, beams);
  };
  const std::string whole = scan([](ScanBeams&) {});
  const auto with_count = [&whole](std::uint64_t count) {
    std::string message = whole;
    return message.replace(16, 4, test::big_endian(count, 4));
  };
  const std::string kScan = "MAEBOT_LASER_SCAN";
  const std::string kTicks = "MAEBOT_MOTOR_FEEDBACK";
  const std::vector<std::tuple<std::string, std::string, std::string>> defects = {
      {kScan, "", "the data end inside a message's fingerprint"},
      {kScan, test::ticks_message(now_us, 0, 0), "fingerprint 8dc5a028fca42ff9 on channel"},
      {kScan, with_count(41), "41 beams in 800 bytes"},
      {kScan, with_count(39), "39 beams in 800 bytes"},
      {kScan, with_count(0), "number of beams is 0"},
      {kScan, with_count(4'000'000'000U), "number of beams is -294967296"},
      {kScan, with_count(2'000'000'000U), "number of beams is 2000000000; expected 1 to 65536"},
      {kScan, whole + "x", "41 beams"},
      {kScan, scan([](auto& b) { b.ranges_m[7] = std::nanf(""); }), "beam 7 has the range nan"},
      {kScan, scan([](auto& b) { b.angles_rad[7] = std::nanf(""); }), "beam 7 points to nan rad"},
      {kScan, scan([](auto& b) { b.angles_rad[7] = 90; }), "beam 7 points to 90 rad"},
      {kScan, scan([](auto& b) { b.times_us[7] -= 5000; }), "time of beam 7 steps back"},
      {kScan, scan([](auto& b) { b.times_us[7] += 2'000'000; }), "beam 7 was taken 2007000 us"},
      {kScan, scan([](auto& b) { b.times_us[7] = -1; }), "stamp of -1 us"},
      {kTicks, test::ticks_message(now_us, 0, 0).substr(0, 40), "the data end inside motor values"},
      {kTicks, test::ticks_message(now_us, 0, 0) + "1234", "4 bytes too many"},
      {kTicks, test::ticks_message(-1, 0, 0), "stamp of -1 us"},
      {"MAEBOT_SENSOR_DATA", "12345678", "fingerprint 3132333435363738"},
      {"MAEBOT_POSE", test::pose_message(now_us, 0, 0, 0).substr(0, 26), "inside theta"},
  };
  for (const auto& [channel, data, message] : defects) {
    LcmLog log = small_lcm_log();
    log.add(now_us, channel, data);
    const auto parsed = parse(log);
    if (message == "41 beams") {  // a byte too many: the counts no longer fit
      EXPECT_FALSE(parsed.has_value());
      continue;
    }
    ASSERT_FALSE(parsed.has_value()) << message;
    const std::string line = parsed.error().to_line();
    EXPECT_NE(line.find(message), std::string::npos) << line;
    EXPECT_NE(line.find("a.lcm: byte "), std::string::npos) << line;
    EXPECT_NE(line.find("; expected "), std::string::npos) << line;
  }
}

TEST(LcmReader, AnAccelerometerInOtherUnitsIsRefused) {
  LcmLog log;
  for (int i = 0; i < 5; ++i) {
    log.add(kBegin_us + i, "MAEBOT_SENSOR_DATA", test::imu_message(kBegin_us + i, 0, 0, 0, 8192));
  }
  const auto parsed = parse(log);
  ASSERT_FALSE(parsed.has_value());
  EXPECT_NE(parsed.error().to_line().find("z reads 0.500 g at the median"), std::string::npos);
}

TEST(LcmReader, RangesInCentimetresAreRefused) {
  ScanBeams beams = test::regular_beams(kBegin_us);
  for (float& range_m : beams.ranges_m) range_m *= 100;
  LcmLog log;
  log.add(kBegin_us, "MAEBOT_LASER_SCAN", test::scan_message(kBegin_us, beams));
  const auto parsed = parse(log);
  ASSERT_FALSE(parsed.has_value());
  EXPECT_NE(parsed.error().to_line().find("40 of 40 ranges lie beyond 8 m"), std::string::npos);
}

TEST(LcmReader, SweepsOfLessThanATurnAreRefused) {
  ScanBeams beams = test::regular_beams(kBegin_us);
  for (float& angle_rad : beams.angles_rad) angle_rad *= 0.25F;
  LcmLog log;
  log.add(kBegin_us, "MAEBOT_LASER_SCAN", test::scan_message(kBegin_us, beams));
  const auto parsed = parse(log);
  ASSERT_FALSE(parsed.has_value());
  EXPECT_NE(parsed.error().to_line().find("sweeps of a whole turn each"), std::string::npos)
      << parsed.error().to_line();
}

TEST(LcmReader, StampsThatStepBackOrRepeatAreRefusedUnderBothClocks) {
  for (const std::int64_t back_us : {0, 10'000}) {
    const std::int64_t last_us = kBegin_us + 950'000 - back_us;
    LcmLog log = small_lcm_log();
    log.add(kBegin_us + 1'000'000, "MAEBOT_MOTOR_FEEDBACK", test::ticks_message(last_us, 0, 0));
    const ScratchFolder folder;
    write_text(folder / "a.lcm", log.bytes());
    ReadLogOptions options;
    options.robot = options_with().robot;
    EXPECT_FALSE(read_log(folder / "a.lcm", options).has_value()) << back_us;
    const auto moved = parse(log, options_with(RawClock::kEventOffset));
    ASSERT_FALSE(moved.has_value()) << back_us;
    EXPECT_NE(moved.error().to_line().find("stamp of the wheels does not increase"),
              std::string::npos);
  }
}

TEST(LcmReader, TicksWithoutWheelsAreRefusedAndASidecarGivesThem) {
  const ScratchFolder folder;
  write_text(folder / "a.lcm.log", small_lcm_log(-50'000'000).bytes());
  const auto refused = read_log(folder / "a.lcm.log");
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().to_line().find("a.robot.toml"), std::string::npos);
  write_text(folder / "a.robot.toml",
             "[wheels]\ntrack_m = 0.1\nleft_m_per_tick = 2e-4\nright_m_per_tick = 2e-4\n"
             "[lidar]\nx_m = 0.05\nrange_max_m = 8.0\ntime_offset_s = 0.01\n"
             "[raw]\nclock = \"event-offset\"\naccel_lsb_per_g = 16384.0\n");
  const auto log = read_log(folder / "a.lcm.log");
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  EXPECT_EQ(log->provenance.format, "lcm");
  EXPECT_EQ(log->num_scans(), 10U);
  EXPECT_EQ(log->robot.lidar.time_offset_s, 0);  // the stamps have it
  EXPECT_NEAR(log->robot.lidar.scan_duration_s, -0.039, 1e-6);
  for (const SensorEvent& event : log->events) {
    const auto* scan = std::get_if<LaserScan>(&event);
    if (scan == nullptr) continue;
    EXPECT_EQ(scan->stamp.nanoseconds, (kBegin_us + 39'000 - 10'000) * 1000);
    EXPECT_EQ(scan->T_base_lidar, Pose2(0.05, 0, 0));
    EXPECT_EQ(scan->range_max_m, 8);
    break;
  }
  write_text(folder / "a.robot.toml", "[raw]\nclock = \"event\"\n");
  const auto wrong = read_log(folder / "a.lcm.log");
  ASSERT_FALSE(wrong.has_value());
  EXPECT_NE(wrong.error().to_line().find("raw.clock = \"event\""), std::string::npos);
}

TEST(LcmReader, IsChosenByTheFirstBytesOfALogAndReadsCompressedOnes) {
  const ScratchFolder folder;
  ReadLogOptions options;
  options.robot = options_with().robot;
  for (const char* name : {"a.log", "a.lcm", "b.lcm.log"}) {
    write_text(folder / name, small_lcm_log().bytes());
    const auto log = read_log(folder / name, options);
    ASSERT_TRUE(log.has_value()) << log.error().to_line();
    EXPECT_EQ(log->provenance.format, "lcm");
  }
  const std::string packed = *gzip(small_lcm_log().bytes());
  write_text(folder / "c.lcm.log.gz", packed);
  EXPECT_TRUE(read_log(folder / "c.lcm.log.gz", options).has_value());
  write_text(folder / "c.lcm.log.gz", packed.substr(0, packed.size() / 2));
  EXPECT_FALSE(read_log(folder / "c.lcm.log.gz", options).has_value());
  EXPECT_EQ(format_from_suffix("a.lcm.log.gz"), LogFormat::kLcm);
  EXPECT_EQ(sidecar_of("d/a.lcm.log.gz", ".tum"), std::filesystem::path("d/a.tum"));
}

TEST(LcmReader, FlippedBitsAreErrorsOrReadingsNeverMore) {
  const std::string bytes = small_lcm_log().bytes();
  Rng rng(11);
  for (int i = 0; i < 500; ++i) {
    std::string flipped = bytes;
    const auto bit =
        static_cast<std::size_t>(rng.uniform() * 8 * static_cast<double>(bytes.size()));
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1U << (bit % 8)));
    const auto clock = i % 2 == 0 ? RawClock::kData : RawClock::kEventOffset;
    const auto parsed = parse_lcm(flipped, "a.lcm", options_with(clock));
    if (!parsed) continue;
    EXPECT_LE(parsed->events.size(), 50U) << "bit " << bit;
  }
}

TEST(LcmReader, ConvertedToTheSuitesFormatNothingIsLostButWhatIsSaid) {
  const ScratchFolder folder;
  write_text(folder / "a.lcm", small_lcm_log().bytes());
  ReadLogOptions options;
  options.robot = options_with().robot;
  const auto log = read_log(folder / "a.lcm", options);
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  ASSERT_TRUE(write_log(*log, folder / "a.rawlog"));
  const auto again = read_log(folder / "a.rawlog");
  ASSERT_TRUE(again.has_value()) << again.error().to_line();
  ASSERT_EQ(again->events.size(), log->events.size());
  for (std::size_t i = 0; i < log->events.size(); ++i) {
    EXPECT_EQ(stamp_of(again->events[i]), stamp_of(log->events[i]));
    const auto* scan = std::get_if<LaserScan>(&log->events[i]);
    if (scan == nullptr) continue;
    const auto& copy = std::get<LaserScan>(again->events[i]);
    EXPECT_EQ(copy.ranges_m, scan->ranges_m);
    EXPECT_EQ(copy.duration_s, scan->duration_s);
    EXPECT_LT((copy.point_base_m(9) - scan->point_base_m(9)).norm(), 1e-5);
  }
  const auto losses = losses_of_conversion(*log, LogFormat::kCarmen);
  EXPECT_NE(std::find(losses.begin(), losses.end(), "10 scans lose the time their sweep took"),
            losses.end());
  const auto refused = write_log(*log, folder / "b.lcm");
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::kUnsupported);
}

TEST(LcmReader, ReadingsAfterTheCutAreLeftOutAndCounted) {
  const ScratchFolder folder;
  write_text(folder / "a.lcm", small_lcm_log().bytes());
  ReadLogOptions options;
  options.robot = options_with().robot;
  options.cut_after_s = 0.5;
  const auto log = read_log(folder / "a.lcm", options);
  ASSERT_TRUE(log.has_value()) << log.error().to_line();
  EXPECT_LE(log->duration_s(), 0.5);
  EXPECT_EQ(log->num_wheel_samples(), 11U);
  EXPECT_TRUE(notes_contain(*log, "23 readings later than 0.5 s"));
}

}  // namespace
}  // namespace corridor::formats
