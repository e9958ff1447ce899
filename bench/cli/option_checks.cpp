#include "bench/cli/option_checks.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

#include "datasets/formats/text.hpp"

namespace corridor::cli {
namespace {

template <class Number>
std::optional<Number> parsed(const std::string& text) {
  Number number = 0;
  const char* const end = text.data() + text.size();
  const auto [parsed_to, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || parsed_to != end) return std::nullopt;
  return number;
}

std::string not_expected(const std::string& text, const std::string& expected) {
  return fmt::format("{} is no value for it; expected {}", formats::quote(text), expected);
}

}  // namespace

OptionCheck number_in(double low, double high) {
  return [low, high](const std::string& text) {
    const std::optional<double> number = parsed<double>(text);
    if (number && *number >= low && *number <= high) return std::string();
    return not_expected(text, fmt::format("a number from {} to {}", low, high));
  };
}

OptionCheck number_above_zero() {
  return [](const std::string& text) {
    const std::optional<double> number = parsed<double>(text);
    if (number && std::isfinite(*number) && *number > 0) return std::string();
    return not_expected(text, "a finite number above 0");
  };
}

OptionCheck whole_number_in(std::int64_t low, std::int64_t high) {
  return [low, high](const std::string& text) {
    const std::optional<std::int64_t> number = parsed<std::int64_t>(text);
    if (number && *number >= low && *number <= high) return std::string();
    return not_expected(text, fmt::format("a whole number from {} to {}", low, high));
  };
}

}  // namespace corridor::cli
