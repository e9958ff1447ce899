// Small helpers every text format of this folder needs: fields, numbers and stamps, independent of
// the locale. It knows no format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "slam/core/timestamp.hpp"

namespace corridor::formats {

// Takes the next field (separated by blanks or tabs) off the front of `line`; empty at the end.
std::string_view take_field(std::string_view& line);

// More fields than a line of any format has: an endless line is read no further.
inline constexpr std::size_t kMaxLineFields = 200'000;

// The fields of a line, at most kMaxLineFields.
std::vector<std::string_view> split_fields(std::string_view line);

// Takes the next line off the front of `text`, without its end ("\n" or "\r\n"); nullopt at the
// end.
std::optional<std::string_view> take_line(std::string_view& text);

// What to note where the last line has no "\n": its last number may be cut. nullopt for whole text.
std::optional<std::string> note_on_end(std::string_view text);

// The whole field must be a number; "nan" and "inf" are numbers here, a leading '+' is allowed.
std::optional<double> parse_double(std::string_view field);
std::optional<std::int64_t> parse_integer(std::string_view field);

// From 1824 to 2115: the time between two stamps fits 64 bits of nanoseconds.
inline constexpr std::int64_t kMaxStamp_ns = 4'600'000'000'000'000'000;

// Decimal seconds to integer nanoseconds without passing through double: Unix times keep their last
// digit. Digits beyond the ninth decimal are rounded. nullopt if not a plain decimal or beyond
// kMaxStamp_ns.
std::optional<Timestamp> parse_stamp(std::string_view field);

// "12.345000000": the inverse of parse_stamp.
std::string format_stamp(Timestamp stamp);

// At most `max_length` bytes of foreign text for error messages. What is no printable ASCII is
// shown as "\xEF": a byte order mark or a look-alike would read as what was expected.
std::string quote(std::string_view text, std::size_t max_length = 40);

}  // namespace corridor::formats
