#include "datasets/formats/lcm/lcm_framing.hpp"

#include <gtest/gtest.h>

#include "tests/datasets/formats/lcm_support.hpp"

namespace corridor::formats {
namespace {

using test::big_endian;
using test::lcm_event;

std::string header(std::uint64_t number, std::uint32_t channel_length, std::uint32_t data_length) {
  return big_endian(0xEDA1DA01, 4) + big_endian(number, 8) + big_endian(5, 8) +
         big_endian(channel_length, 4) + big_endian(data_length, 4);
}

TEST(LcmFraming, EventsAreFoundWithTheirBytes) {
  const std::string first = lcm_event(7, 1234, "A_CHANNEL", "data");
  const std::string bytes = first + lcm_event(8, 1233, "B", "");
  const auto events = split_lcm_events(bytes, "a.lcm");
  ASSERT_TRUE(events.has_value()) << events.error().to_line();
  ASSERT_EQ(events->size(), 2U);
  EXPECT_EQ((*events)[0].channel, "A_CHANNEL");
  EXPECT_EQ((*events)[0].data, "data");
  EXPECT_EQ((*events)[0].utime_us, 1234);
  EXPECT_EQ((*events)[0].data_begin, first.size() - 4);
  EXPECT_EQ((*events)[1].begin, first.size());
  EXPECT_TRUE(begins_with_lcm_sync(bytes));
  EXPECT_FALSE(begins_with_lcm_sync("FLASER"));
}

TEST(LcmFraming, AnswersEachDefectWithItsByte) {
  const std::string good = lcm_event(0, 5, "CHANNEL", "12345678");
  const std::vector<std::pair<std::string, std::string>> defects = {
      {"garbage of some length", "no event begins here"},
      {std::string(28, '\0'), "no event begins here"},
      {lcm_event(2, 5, "C", ""), "event number 2; expected 1"},
      {lcm_event(0, 5, "C", ""), "event number 0; expected 1"},
      {lcm_event(1, -5, "C", ""), "event time of -5 us"},
      {lcm_event(1, 9'000'000'000'000'000'000, "C", ""), "event time of"},
      {header(1, 0, 0), "channel length is 0"},
      {header(1, 64, 0), "channel length is 64; expected 1 to 63"},
      {header(1, 4'000'000'000U, 0), "channel length is 4000000000"},
      {header(1, 1, 4'000'000'000U), "data length is 4000000000"},
      {header(1, 1, 16'777'216U) + "C", "the data end inside an event's data"},
      {lcm_event(1, 5, "A B", ""), "channel 'A B'"},
      {lcm_event(1, 5, std::string("A\0B", 3), ""), "channel 'A\\x00B'"},
  };
  for (const auto& [damage, message] : defects) {
    const auto events = split_lcm_events(good + damage, "a.lcm");
    ASSERT_FALSE(events.has_value()) << message;
    const std::string line = events.error().to_line();
    EXPECT_NE(line.find(message), std::string::npos) << line;
    EXPECT_NE(line.find("a.lcm: byte "), std::string::npos) << line;
    EXPECT_NE(line.find("; expected "), std::string::npos) << line;
  }
}

TEST(LcmFraming, AFileCutInsideAnEventIsAnError) {
  const std::string first = lcm_event(0, 5, "CHANNEL", "12345678");
  const std::string bytes = first + first.substr(0, 4) + big_endian(1, 8) + first.substr(12);
  for (std::size_t length = 1; length < bytes.size(); ++length) {
    const auto events = split_lcm_events(bytes.substr(0, length), "a.lcm");
    EXPECT_EQ(events.has_value(), length == first.size()) << "cut at byte " << length;
  }
}

TEST(LcmFraming, AFlippedBitInAHeaderIsAnErrorOrChangesNoFrame) {
  std::string bytes;
  for (std::uint64_t i = 0; i < 5; ++i) bytes += lcm_event(i, 1000, "CHANNEL", "12345678");
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string flipped = bytes;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1U << (bit % 8)));
    const auto events = split_lcm_events(flipped, "a.lcm");
    if (!events) continue;  // time, name and data may flip: the next layers look at them
    EXPECT_EQ(events->size(), 5U) << "bit " << bit;
    EXPECT_EQ(events->back().data.size(), 8U) << "bit " << bit;
  }
}

}  // namespace
}  // namespace corridor::formats
