#include "datasets/formats/rawlog/stated_readings.hpp"

#include <fmt/format.h>

#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

constexpr std::string_view kBeginning = "# readings that follow:";

}  // namespace

std::string stated_readings_line(std::size_t num_readings) {
  return fmt::format("{} {}\n", kBeginning, num_readings);
}

Result<std::optional<std::uint64_t>> stated_readings(std::string_view comment,
                                                     const std::string& where) {
  auto line = take_line(comment);
  if (!line || !line->starts_with(kBeginning)) return std::nullopt;
  line->remove_prefix(kBeginning.size());
  const std::string_view field = take_field(*line);
  const auto count = parse_integer(field);
  if (!count || *count < 0) {
    return fail(ErrorCode::kMalformed, "number of readings " + quote(field), where,
                "a whole number from 0 on");
  }
  return static_cast<std::uint64_t>(*count);
}

}  // namespace corridor::formats
