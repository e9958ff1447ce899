// Checks of numbers that options take, as CLI11 asks for them: what is wrong with the text, empty
// for nothing. Its own let NaN through, and write a range with all of its digits.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace corridor::cli {

using OptionCheck = std::function<std::string(const std::string& text)>;

// A finite number in [low, high].
OptionCheck number_in(double low, double high);
// A finite number above 0.
OptionCheck number_above_zero();
// A whole number in [low, high].
OptionCheck whole_number_in(std::int64_t low, std::int64_t high);

}  // namespace corridor::cli
