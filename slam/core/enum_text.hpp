// Enumerators by their texts, for options and parameters: an enumeration with `to_text(value)` and
// an array of its values needs no more.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace corridor {

template <class Enum, std::size_t kSize>
std::vector<std::string> texts_of(const std::array<Enum, kSize>& values) {
  std::vector<std::string> texts;
  for (const Enum value : values) texts.emplace_back(to_text(value));
  return texts;
}

template <class Enum, std::size_t kSize>
std::optional<Enum> from_text(const std::array<Enum, kSize>& values, std::string_view text) {
  const auto found = std::find_if(values.begin(), values.end(),
                                  [text](Enum value) { return to_text(value) == text; });
  return found == values.end() ? std::nullopt : std::optional<Enum>(*found);
}

}  // namespace corridor
