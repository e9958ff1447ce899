// One defect, every format that can have it: text with bytes changed or cut off, endless lines,
// other units, stamps of few digits, clocks that jump, a locale with a decimal comma.
#include <gtest/gtest.h>

#include <clocale>
#include <locale>
#include <map>

#include "datasets/formats/log_health.hpp"
#include "datasets/formats/log_io.hpp"
#include "datasets/formats/robot_toml.hpp"
#include "datasets/formats/trajectories/relations.hpp"
#include "datasets/formats/trajectories/trajectory_io.hpp"
#include "tests/datasets/formats/golden_support.hpp"
#include "tests/datasets/formats/lcm_support.hpp"
#include "tests/datasets/formats/text_formats.hpp"

namespace corridor::formats {
namespace {

using test::golden_file;
using test::joined;
using test::Outcome;
using test::read_as_log;
using test::read_text;
using test::ScratchFolder;
using test::text_formats;
using test::TextFormat;
using test::write_text;

class EveryTextFormat : public ::testing::TestWithParam<TextFormat> {};

// Without the map's description, which may end without a line's end and with keys of other
// programs.
class EveryLineFormat : public EveryTextFormat {};
// Without ticks, which are whole numbers.
class EveryDecimalFormat : public EveryTextFormat {};

std::vector<TextFormat> text_formats_without(const std::string& name) {
  std::vector<TextFormat> formats = text_formats();
  std::erase_if(formats, [&](const TextFormat& format) { return format.name == name; });
  return formats;
}

const auto kNameOf = [](const auto& format) { return format.param.name; };
INSTANTIATE_TEST_SUITE_P(FormatDefects, EveryTextFormat, ::testing::ValuesIn(text_formats()),
                         kNameOf);
INSTANTIATE_TEST_SUITE_P(FormatDefects, EveryLineFormat,
                         ::testing::ValuesIn(text_formats_without("ros_map")), kNameOf);
INSTANTIATE_TEST_SUITE_P(FormatDefects, EveryDecimalFormat,
                         ::testing::ValuesIn(text_formats_without("ticks")), kNameOf);

TEST_P(EveryTextFormat, IsReadWholeAndWithoutANoteOnItsEnd) {
  const Outcome whole = GetParam().read(GetParam().text);
  ASSERT_TRUE(whole.is_read) << whole.said;
  EXPECT_GT(whole.num_readings, 0U);
  EXPECT_EQ(whole.said.find("the last line has no end"), std::string::npos);
}

// Of what is cut within a line nothing passes unsaid.
TEST_P(EveryLineFormat, CutAnywhereIsRefusedOrNotedAndGivesNoMoreReadings) {
  const TextFormat& format = GetParam();
  const Outcome whole = format.read(format.text);
  const std::size_t step = format.text.size() / 400 + 1;
  for (std::size_t size = 0; size < format.text.size(); size += step) {
    const std::string cut = format.text.substr(0, size);
    const Outcome outcome = format.read(cut);
    if (!outcome.is_read) continue;
    EXPECT_LE(outcome.num_readings, whole.num_readings) << size;
    if (cut.back() == '\n') continue;
    EXPECT_NE(outcome.said.find("the last line has no end"), std::string::npos) << cut;
  }
}

TEST_P(EveryLineFormat, AnEndlessLineIsRefusedWithOneShortLine) {
  std::string endless = GetParam().text;
  for (int i = 0; i < 1'000'000; ++i) endless += "1 1,";
  const Outcome outcome = GetParam().read(endless);
  EXPECT_FALSE(outcome.is_read);
  EXPECT_LT(outcome.said.size(), 400U) << outcome.said;
  EXPECT_EQ(outcome.said.find('\n'), std::string::npos);
}

TEST_P(EveryDecimalFormat, ADecimalCommaIsRefused) {
  // Where the first number with a point stands that the reader asks for; else behind the head.
  const std::map<std::string, std::string> places = {
      {"flaser", "FLASER"}, {"carmen_trajectory", " 0.05"}, {"euroc", "0.5,"}};
  const auto place = places.find(GetParam().name);
  std::string text = GetParam().text;
  const std::size_t point = text.find('.', text.find(place == places.end() ? "\n" : place->second));
  ASSERT_NE(point, std::string::npos);
  text[point] = ',';
  EXPECT_FALSE(GetParam().read(text).is_read);
}

// Reads as in a country with a decimal comma, whether the C library knows one or not.
class DecimalComma {
 public:
  DecimalComma() {
    struct Comma : std::numpunct<char> {
      [[nodiscard]] char do_decimal_point() const override { return ','; }
      [[nodiscard]] char do_thousands_sep() const override { return '.'; }
      [[nodiscard]] std::string do_grouping() const override { return "\3"; }
    };
    std::locale::global(std::locale(std::locale::classic(), new Comma));
    for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "pt_BR.UTF-8", "ru_RU.UTF-8"}) {
      if (std::setlocale(LC_ALL, name) != nullptr) break;
    }
  }
  ~DecimalComma() {
    std::locale::global(std::locale::classic());
    std::setlocale(LC_ALL, "C");
  }
  DecimalComma(const DecimalComma&) = delete;
  DecimalComma& operator=(const DecimalComma&) = delete;
};

TEST_P(EveryTextFormat, IsReadTheSameUnderALocaleWithADecimalComma) {
  const Outcome plain = GetParam().read(GetParam().text);
  const DecimalComma comma;
  const Outcome abroad = GetParam().read(GetParam().text);
  EXPECT_EQ(abroad.is_read, plain.is_read);
  EXPECT_EQ(abroad.num_readings, plain.num_readings);
  EXPECT_EQ(abroad.said, plain.said);
}

TEST(FormatDefects, NumbersAreReadAndWrittenTheSameUnderALocaleWithADecimalComma) {
  const std::string toml = read_text(golden_file("robot_toml/whole.toml"));
  const SensorLog log = test::small_log();
  const ScratchFolder folder;
  ASSERT_TRUE(write_log(log, folder / "plain.clf"));
  const auto robot = robot_from_toml(toml, "whole.toml");
  ASSERT_TRUE(robot.has_value());
  const DecimalComma comma;
  const auto abroad = robot_from_toml(toml, "whole.toml");
  ASSERT_TRUE(abroad.has_value()) << abroad.error().to_line();
  EXPECT_EQ(robot_to_toml(*abroad), robot_to_toml(*robot));
  EXPECT_EQ(abroad->lidar.range_sigma_m, 0.015);
  ASSERT_TRUE(write_log(log, folder / "abroad.clf"));
  EXPECT_EQ(read_text(folder / "abroad.clf"), read_text(folder / "plain.clf"));
  const auto read = read_log(folder / "abroad.clf");
  ASSERT_TRUE(read.has_value()) << read.error().to_line();
  EXPECT_EQ(read->num_scans(), log.num_scans());
}

// Stamps with an exponent, or so few digits that two readings share one.
TEST(FormatDefects, StampsOfFewDigitsAreRefused) {
  const ScratchFolder folder;
  const auto said_of_log = [&](const char* file, const std::string& text) {
    write_text(folder / file, text);
    return read_as_log(folder / file).said;
  };
  const std::string odom = "ODOM 0 0 0 0 0 0 ";
  EXPECT_NE(said_of_log("a.clf", odom + "1.1e9 h 0\n").find("stamp '1.1e9'"), std::string::npos);
  EXPECT_NE(said_of_log("b.clf", odom + "1.1 h 0\n" + odom + "1.1 h 0\n").find("stamp repeats"),
            std::string::npos);
  const auto said_of_poses = [&](const std::string& text) {
    write_text(folder / "a.tum", text);
    const auto read = read_trajectory(folder / "a.tum");
    return read ? std::string("read") : read.error().to_line();
  };
  EXPECT_NE(said_of_poses("1.1e9 0 0 0 0 0 0 1\n").find("stamp '1.1e9'"), std::string::npos);
  EXPECT_NE(said_of_poses("7 0 0 0 0 0 0 1\n7 1 0 0 0 0 0 1\n").find("not later than the last"),
            std::string::npos);
  write_text(folder / "a.relations", "1.1e9 2 0 0 0 0 0 0\n");
  EXPECT_NE(read_relations(folder / "a.relations").error().to_line().find("stamp '1.1e9'"),
            std::string::npos);
}

Outcome read_lcm(std::int64_t jump_us, std::vector<std::string>* suspicions = nullptr) {
  const ScratchFolder folder;
  write_text(folder / "a.lcm", test::small_lcm_log(0, jump_us).bytes());
  write_text(folder / "a.robot.toml",
             "[wheels]\ntrack_m = 0.1\nleft_m_per_tick = 1e-4\nright_m_per_tick = 1e-4\n"
             "[lidar]\nrange_max_m = 8\n");
  const auto log = read_log(folder / "a.lcm");
  if (log && suspicions != nullptr) *suspicions = examine(*log).suspicions;
  return read_as_log(folder / "a.lcm");
}

TEST(FormatDefects, AnLcmLogWhoseClocksJumpIsRefusedOrSuspicious) {
  EXPECT_NE(read_lcm(-300'000).said.find("stamp"), std::string::npos);
  EXPECT_FALSE(read_lcm(-300'000).is_read);
  EXPECT_FALSE(read_lcm(12'000'000).is_read);
  EXPECT_NE(read_lcm(12'000'000).said.find("gap of 12."), std::string::npos);
  std::vector<std::string> suspicions;
  EXPECT_TRUE(read_lcm(5'000'000, &suspicions).is_read);
  EXPECT_NE(joined(suspicions).find("LiDAR: no reading for 5."), std::string::npos);
  EXPECT_TRUE(read_lcm(0, &suspicions).is_read);
  EXPECT_EQ(joined(suspicions).find("no reading"), std::string::npos);
}

// Poses may be far apart, but not in another order.
TEST(FormatDefects, ATrajectoryWhoseClockJumpsBackIsRefusedAndOneWithAGapKeepsItsStamps) {
  const ScratchFolder folder;
  const auto write_poses = [&](const char* last_s) {
    write_text(folder / "a.tum",
               "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n" + std::string(last_s) + " 0 0 0 0 0 0 1\n");
    return read_trajectory(folder / "a.tum");
  };
  const auto back = write_poses("1.5");
  ASSERT_FALSE(back.has_value());
  EXPECT_NE(back.error().to_line().find("a.tum:3: stamp '1.5' is not later"), std::string::npos);
  const auto ahead = write_poses("7.000000001");
  ASSERT_TRUE(ahead.has_value()) << ahead.error().to_line();
  EXPECT_EQ(ahead->trajectory[2].stamp.nanoseconds, 7'000'000'001);
}

}  // namespace
}  // namespace corridor::formats
