#include "datasets/formats/text.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace corridor::formats {
namespace {

RC_GTEST_PROP(Stamp, ParseUndoesFormat, (std::int64_t nanoseconds)) {
  RC_PRE(nanoseconds > -kMaxStamp_ns && nanoseconds < kMaxStamp_ns);
  const auto parsed = parse_stamp(format_stamp({nanoseconds}));
  RC_ASSERT(parsed.has_value());
  RC_ASSERT(parsed->nanoseconds == nanoseconds);
}

TEST(Stamp, KeepsTheLastDigitOfUnixTimes) {
  EXPECT_EQ(parse_stamp("976052857.3372")->nanoseconds, 976'052'857'337'200'000LL);
  EXPECT_EQ(parse_stamp("1700000000.123456789")->nanoseconds, 1'700'000'000'123'456'789LL);
}

TEST(Stamp, RoundsBeyondNineDecimals) {
  EXPECT_EQ(parse_stamp("0.9999999995")->nanoseconds, 1'000'000'000);
  EXPECT_EQ(parse_stamp("-0.0000000014")->nanoseconds, -1);
}

TEST(Stamp, RefusesWhatIsNotAPlainDecimal) {
  for (const char* text : {"", "-", ".", ".5", "1e9", "nan", "inf", "0x10", "1,5", "12 ", "--1",
                           "99999999999999999999", "4600000000", "-4600000000"}) {
    EXPECT_FALSE(parse_stamp(text).has_value()) << text;
  }
  EXPECT_EQ(parse_stamp("5.")->nanoseconds, 5'000'000'000);
}

TEST(Number, IsTheWholeFieldOrNothing) {
  EXPECT_EQ(parse_double("+1.5"), 1.5);
  EXPECT_EQ(parse_double("-1e-3"), -1e-3);
  for (const char* text : {"", "1.5m", "1,5", "+-1", "0x1", "abc"}) {
    EXPECT_FALSE(parse_double(text).has_value()) << text;
  }
  EXPECT_FALSE(parse_integer("4000000000000000000000").has_value());
}

TEST(Lines, EndWithOrWithoutCarriageReturnOrLastNewline) {
  std::string_view text = "a\r\nb\n\nc";
  EXPECT_EQ(take_line(text), "a");
  EXPECT_EQ(take_line(text), "b");
  EXPECT_EQ(take_line(text), "");
  EXPECT_EQ(take_line(text), "c");
  EXPECT_EQ(take_line(text), std::nullopt);
}

TEST(Fields, AreSeparatedByAnyNumberOfBlanks) {
  EXPECT_EQ(split_fields("  a\tbc   d "), (std::vector<std::string_view>{"a", "bc", "d"}));
  EXPECT_TRUE(split_fields("   ").empty());
}

TEST(Quote, ShowsWhatIsNoPrintableAsciiByItsBytes) {
  EXPECT_EQ(quote("\xEF\xBB\xBF"
                  "FLASER"),
            R"('\xEF\xBB\xBFFLASER')");
  EXPECT_EQ(quote("a\tb\x7F"), R"('a\x09b\x7F')");
  EXPECT_EQ(quote("abcdef", 3), "'abc...'");
}

}  // namespace
}  // namespace corridor::formats
