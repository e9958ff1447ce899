// Strict reading of TOML tables into parameter structs: every problem is collected with its line.
// Internal to this folder: it shows the TOML library, so only the .cpp files that parse include it.
#pragma once

#include <toml++/toml.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "slam/core/params.hpp"
#include "slam/core/result.hpp"

namespace corridor::simulation {

struct TomlProblem {
  std::uint32_t line = 0;  // 0 = the whole file
  std::string text;        // what; expected ...
};

// Fails with the file and the line of a syntax error, or if the file states nothing.
Result<toml::table> parse_toml(const std::filesystem::path& path);

// "file:line: text; file:line: text" as one Error. Requires a problem.
Error to_error(const std::filesystem::path& path, const std::vector<TomlProblem>& problems);

// Line of section.key, or of the section, or 0.
std::uint32_t line_of(const toml::table& document, std::string_view section, std::string_view key);

// One problem per key of the table that is not in `known`.
void find_unknown_keys(const toml::table& table, std::string_view section,
                       const std::vector<std::string>& known, std::vector<TomlProblem>& problems);

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

// "[x, y]" and a list of such; numbers only. What is not is a problem and reads as (0, 0).
Eigen::Vector2d read_point(const toml::node& node, std::string_view key,
                           std::vector<TomlProblem>& problems);
std::vector<Eigen::Vector2d> read_points(const toml::node& node, std::string_view key,
                                         std::vector<TomlProblem>& problems);

enum class MissingKeys { kKeepDefault, kAreErrors };

// Sets the fields of `params` from the keys of the table; ranges are not checked here. Keys in
// `read_elsewhere` are not looked at. Give the parsed table itself: a copy has lost its lines.
template <class P>
void read_table(const toml::table& table, std::string_view section, MissingKeys missing, P& params,
                std::vector<TomlProblem>& problems,
                const std::vector<std::string>& read_elsewhere = {}) {
  std::vector<std::string> known = read_elsewhere;
  P::visit(params, [&](const ParamInfo& info, auto& field) {
    using T = std::remove_reference_t<decltype(field)>;
    known.emplace_back(info.name);
    const toml::node* node = table.get(info.name);
    if (node == nullptr) {
      if (missing == MissingKeys::kAreErrors) {
        problems.push_back(
            {table.source().begin.line, fmt::format("{}.{} is missing; expected {}", section,
                                                    info.name, detail::type_name<T>())});
      }
    } else if (!read_value(*node, field)) {
      problems.push_back(
          {node->source().begin.line, fmt::format("{}.{} has another type; expected {}", section,
                                                  info.name, detail::type_name<T>())});
    } else if constexpr (std::is_same_v<T, double>) {
      if (std::isfinite(field)) return;
      problems.push_back(
          {node->source().begin.line,
           fmt::format("{}.{} is not finite; expected a number", section, info.name)});
    }
  });
  find_unknown_keys(table, section, known, problems);
}

}  // namespace corridor::simulation
