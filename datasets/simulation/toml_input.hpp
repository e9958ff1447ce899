// Strict reading of TOML tables into parameter structs: every problem is collected with its line.
// Internal to this folder: it shows the TOML library, so only the .cpp files that parse include it.
#pragma once

#include <toml++/toml.h>

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "datasets/formats/toml_problems.hpp"
#include "slam/core/params.hpp"
#include "slam/core/result.hpp"

namespace corridor::simulation {

using formats::find_unknown_keys;
using formats::read_value;
using formats::to_error;
using formats::TomlProblem;

// Fails with the file and the line of a syntax error, or if the file states nothing.
Result<toml::table> parse_toml(const std::filesystem::path& path);

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
    } else {
      formats::read_field(*node, fmt::format("{}.{}", section, info.name), field, problems);
    }
  });
  find_unknown_keys(table, section, known, problems);
}

}  // namespace corridor::simulation
