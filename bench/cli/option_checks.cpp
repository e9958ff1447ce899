#include "bench/cli/option_checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "datasets/formats/text.hpp"

namespace corridor::cli {
namespace {

std::string not_expected(const std::string& text, const std::string& expected) {
  return fmt::format("{} is no value for it; expected {}", formats::quote(text), expected);
}

}  // namespace

OptionCheck number_in(double low, double high) {
  return [low, high](const std::string& text) {
    const std::optional<double> number = formats::parse_double(text);
    if (number && *number >= low && *number <= high) return std::string();
    return not_expected(text, fmt::format("a number from {} to {}", low, high));
  };
}

OptionCheck number_above_zero() {
  return [](const std::string& text) {
    const std::optional<double> number = formats::parse_double(text);
    if (number && std::isfinite(*number) && *number > 0) return std::string();
    return not_expected(text, "a finite number above 0");
  };
}

OptionCheck whole_number_in(std::int64_t low, std::int64_t high) {
  return [low, high](const std::string& text) {
    const std::optional<std::int64_t> number = formats::parse_integer(text);
    if (number && *number >= low && *number <= high) return std::string();
    return not_expected(text, fmt::format("a whole number from {} to {}", low, high));
  };
}

}  // namespace corridor::cli
