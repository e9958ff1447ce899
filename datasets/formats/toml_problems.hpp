// Strict reading of TOML tables: every problem is collected with its line, and one Error lists them
// all. Internal to datasets/: it shows the TOML library, so only .cpp files that parse, and the
// headers that only they include, include it.
#pragma once

#include <fmt/format.h>
#include <toml++/toml.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "slam/core/params.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

struct TomlProblem {
  std::uint32_t line = 0;  // 0 = the whole file
  std::string text;        // the key's path and what; expected ...
};

// "where:line: text; where:line: text" as one Error. Requires a problem.
Error to_error(const std::string& where, const std::vector<TomlProblem>& problems);

// "section.key"; the key alone without a section.
std::string path_of(std::string_view section, std::string_view key);

// Line of section.key, or of the section, or 0.
std::uint32_t line_of(const toml::table& document, std::string_view section, std::string_view key);

// "lidar.range_max_m = 3: expected ..." stands in the line of that key.
std::uint32_t line_of_violation(const toml::table& document, std::string_view violation);

// One problem per key of the table that is not in `known`.
void find_unknown_keys(const toml::table& table, std::string_view section,
                       const std::vector<std::string>& known, std::vector<TomlProblem>& problems);

// "wheels.track_m is a text; expected number".
TomlProblem wrong_type(const toml::node& node, std::string_view path, std::string_view expected);

TomlProblem out_of_range(const toml::node& node, std::string_view path, std::string_view expected);

// "wheels is not a table; expected one".
TomlProblem no_table(const toml::node& node, std::string_view path);

// Numbers may be written without a point; nothing else is converted. False = wrong type.
template <class T>
bool read_value(const toml::node& node, T& value) {
  if constexpr (std::is_same_v<T, double>) {
    if (!node.is_number()) return false;
    const auto found = node.value<double>();  // none for an integer that no double holds
    if (!found) return false;
    value = *found;
  } else if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::string>) {
    const auto found = node.value_exact<T>();
    if (!found) return false;
    value = *found;
  } else {
    const auto found = node.value_exact<std::int64_t>();
    if (!found || !std::in_range<T>(*found)) return false;
    value = static_cast<T>(*found);
  }
  return true;
}

// What a whole number that is out of range should have been.
template <class T>
std::string room_of() {
  if constexpr (std::is_integral_v<T>) {
    return fmt::format("{} from {} to {}", detail::type_name<T>(), std::numeric_limits<T>::min(),
                       std::numeric_limits<T>::max());
  } else {
    return fmt::format("{} that a double holds", detail::type_name<T>());
  }
}

// Of the right type and finite, or a problem; the range is not checked here.
template <class T>
void read_field(const toml::node& node, std::string_view path, T& field,
                std::vector<TomlProblem>& problems) {
  T found{};
  if (!read_value(node, found)) {
    const bool is_out_of_range = std::is_arithmetic_v<T> && !std::is_same_v<T, bool> &&
                                 node.is_integer();  // the type is right, there is no room for it
    problems.push_back(is_out_of_range ? out_of_range(node, path, room_of<T>())
                                       : wrong_type(node, path, detail::type_name<T>()));
    return;
  }
  if constexpr (std::is_same_v<T, double>) {
    if (!std::isfinite(found)) {
      problems.push_back(
          {node.source().begin.line, fmt::format("{} is not finite; expected a number", path)});
      return;
    }
  }
  field = std::move(found);
}

}  // namespace corridor::formats
