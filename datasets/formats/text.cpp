#include "datasets/formats/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace corridor::formats {
namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr std::int64_t kNanoseconds = 1'000'000'000;
constexpr int kStampDecimals = 9;

template <class T>
std::optional<T> parse_number(std::string_view field) {
  if (field.size() > 1 && field.front() == '+' && field[1] != '-') field.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size()) return std::nullopt;
  return value;
}

bool is_all_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// Nanoseconds of the digits behind the point, rounded half up; may be a whole second.
std::int64_t fraction_ns(std::string_view digits) {
  std::int64_t value = 0;
  for (int i = 0; i < kStampDecimals; ++i) {
    const auto index = static_cast<std::size_t>(i);
    value = value * 10 + (index < digits.size() ? digits[index] - '0' : 0);
  }
  const bool rounds_up = digits.size() > kStampDecimals && digits[kStampDecimals] >= '5';
  return rounds_up ? value + 1 : value;
}

}  // namespace

std::string_view take_field(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const std::size_t length = std::min(line.find_first_of(kBlanks), line.size());
  const std::string_view field = line.substr(0, length);
  line.remove_prefix(length);
  return field;
}

std::vector<std::string_view> split_fields(std::string_view line) {
  std::vector<std::string_view> fields;
  for (auto field = take_field(line); !field.empty(); field = take_field(line)) {
    fields.push_back(field);
    if (fields.size() == kMaxLineFields) break;
  }
  return fields;
}

std::optional<std::string_view> take_line(std::string_view& text) {
  if (text.empty()) return std::nullopt;
  const std::size_t length = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, length);
  text.remove_prefix(std::min(length + 1, text.size()));
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::optional<std::string> note_on_end(std::string_view text) {
  if (text.empty() || text.back() == '\n') return std::nullopt;
  return "the last line has no end: the file may have been cut short";
}

std::optional<double> parse_double(std::string_view field) { return parse_number<double>(field); }

std::optional<std::int64_t> parse_integer(std::string_view field) {
  return parse_number<std::int64_t>(field);
}

std::optional<Timestamp> parse_stamp(std::string_view field) {
  const bool is_negative = !field.empty() && field.front() == '-';
  if (is_negative) field.remove_prefix(1);
  const std::size_t point = std::min(field.find('.'), field.size());
  const std::string_view whole = field.substr(0, point);
  const std::string_view fraction = point < field.size() ? field.substr(point + 1) : "";
  if (whole.empty() || !is_all_digits(whole) || !is_all_digits(fraction)) return std::nullopt;
  const auto seconds = parse_integer(whole);
  if (!seconds || *seconds >= kMaxStamp_ns / kNanoseconds) return std::nullopt;
  const std::int64_t nanoseconds = *seconds * kNanoseconds + fraction_ns(fraction);
  return Timestamp{is_negative ? -nanoseconds : nanoseconds};
}

std::string format_stamp(Timestamp stamp) {
  const bool is_negative = stamp.nanoseconds < 0;
  // Negating as unsigned is defined for the most negative value too.
  const auto bits = static_cast<std::uint64_t>(stamp.nanoseconds);
  const std::uint64_t magnitude = is_negative ? 0 - bits : bits;
  constexpr auto kUnit = static_cast<std::uint64_t>(kNanoseconds);
  return fmt::format("{}{}.{:09}", is_negative ? "-" : "", magnitude / kUnit, magnitude % kUnit);
}

std::string quote(std::string_view text, std::size_t max_length) {
  std::string quoted = "'";
  for (const char c : text.substr(0, max_length)) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_visible = byte >= ' ' && byte <= '~';
    quoted += is_visible ? std::string(1, c) : fmt::format("\\x{:02X}", byte);
  }
  quoted += text.size() > max_length ? "...'" : "'";
  return quoted;
}

}  // namespace corridor::formats
