// A changed byte in any text format.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/datasets/formats/text_formats.hpp"

namespace corridor::formats {
namespace {

using test::Outcome;
using test::text_formats;
using test::TextFormat;

// True where a byte of a comment would be changed, or a comment made: which is no corruption.
bool concerns_comment(const std::string& text, std::size_t at, char byte) {
  const std::size_t line = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;
  return byte == '#' || text[line] == '#';
}

// What is wrong with how a format takes one changed byte; empty: nothing.
std::string complaint_on_changed_byte(const TextFormat& format, std::size_t at, char byte) {
  std::string text = format.text;
  text[at] = byte;
  const Outcome whole = format.read(format.text);
  const Outcome changed = format.read(text);
  const bool is_one_line = changed.said.find('\n') == std::string::npos;
  const bool is_as_many = changed.num_readings == whole.num_readings;
  if (changed.is_read ? is_as_many : is_one_line) return "";
  return fmt::format("{}: byte {} set to {}: {} instead of {} readings, said '{}'", format.name, at,
                     static_cast<unsigned char>(byte), changed.num_readings, whole.num_readings,
                     changed.said);
}

RC_GTEST_PROP(FormatDefects, AChangedByteIsRefusedOrKeepsTheNumberOfReadings, ()) {
  static const std::vector<TextFormat> formats = text_formats();
  const TextFormat& format = *rc::gen::elementOf(formats);
  const auto at = *rc::gen::inRange<std::size_t>(0, format.text.size());
  const auto byte = static_cast<char>(*rc::gen::inRange(0, 256));
  RC_PRE(!concerns_comment(format.text, at, byte));
  const std::string complaint = complaint_on_changed_byte(format, at, byte);
  if (!complaint.empty()) RC_FAIL(complaint);
}

// Where random changes seldom fall: what joins two lines, and the last byte of a line.
TEST(FormatDefects, AChangedEndOfALineIsRefusedOrKeepsTheNumberOfReadings) {
  for (const TextFormat& format : text_formats()) {
    for (std::size_t end = format.text.find('\n'); end != std::string::npos;
         end = format.text.find('\n', end + 1)) {
      for (const std::size_t at : {end - 1, end}) {
        for (const char byte : {'\0', ' ', '0'}) {
          if (concerns_comment(format.text, at, byte)) continue;
          EXPECT_EQ(complaint_on_changed_byte(format, at, byte), "");
        }
      }
    }
  }
}

}  // namespace
}  // namespace corridor::formats
