// The table [family] of a scenario file.
#include "datasets/simulation/scenario_family.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>

#include "datasets/simulation/scenario_file.hpp"
#include "datasets/simulation/toml_input.hpp"

namespace corridor::simulation {
namespace {

namespace fs = std::filesystem;

// A number, or text that can be a part of a name.
bool read_member(const toml::node& node, std::string& value) {
  double number = 0;
  if (read_value(node, number)) {
    value = fmt::format("{}", number);
    return true;
  }
  const auto is_plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
  };
  return read_value(node, value) && !value.empty() &&
         std::all_of(value.begin(), value.end(), is_plain);
}

// Whether there is such a parameter in the scenario, or presets of such a sensor.
bool is_known(const Family& family, const Scenario& scenario) {
  if (family.is_of_presets()) return has_presets(family.section());
  return family.key.find('.') != std::string::npos &&
         scenario_values(scenario).count(family.key) > 0;
}

std::vector<std::string> read_values(const toml::array& list, std::vector<TomlProblem>& problems) {
  std::vector<std::string> values;
  for (const toml::node& node : list) {
    std::string value;
    const std::uint32_t line = node.source().begin.line;
    if (!read_member(node, value)) {
      problems.push_back({line, "family.values: expected numbers, or names of letters and digits"});
    } else if (std::find(values.begin(), values.end(), value) != values.end()) {
      problems.push_back(
          {line, fmt::format("family.values: {} stands there twice; expected it once", value)});
    } else {
      values.push_back(value);
    }
  }
  return values;
}

Family read_family_table(const toml::table& table, const Scenario& scenario,
                         std::vector<TomlProblem>& problems) {
  find_unknown_keys(table, "family", {"key", "values"}, problems);
  const std::uint32_t line = table.source().begin.line;
  Family family;
  const toml::node* key = table.get("key");
  if (key == nullptr || !read_value(*key, family.key)) {
    problems.push_back({line, "family.key: expected a parameter, as \"lidar.range_max_m\""});
  } else if (!is_known(family, scenario)) {
    problems.push_back({key->source().begin.line,
                        fmt::format("unknown scenario key {} in family.key; expected a parameter, "
                                    "as lidar.range_max_m, or presets, as imu.preset",
                                    family.key)});
  }
  const toml::node* values = table.get("values");
  const toml::array* list = values == nullptr ? nullptr : values->as_array();
  if (list != nullptr && !list->empty()) {
    family.values = read_values(*list, problems);
  } else {
    problems.push_back({line, "family.values: expected a list of numbers or names"});
  }
  return family;
}

}  // namespace

std::string Family::section() const { return key.substr(0, key.find('.')); }

bool Family::is_of_presets() const { return key == section() + ".preset"; }

Result<std::optional<Family>> read_family(const fs::path& path) {
  const Result<toml::table> document = parse_toml(path);
  if (!document) return tl::make_unexpected(document.error());
  const toml::node* node = document->get("family");
  if (node == nullptr) return std::optional<Family>();
  const Result<Scenario> scenario = read_scenario(path);
  if (!scenario) return tl::make_unexpected(scenario.error());
  std::vector<TomlProblem> problems;
  Family family;
  if (const toml::table* table = node->as_table()) {
    family = read_family_table(*table, *scenario, problems);
  } else {
    problems.push_back(formats::no_table(*node, "family"));
  }
  if (!problems.empty()) return tl::make_unexpected(to_error(path, problems));
  return std::optional<Family>(std::move(family));
}

}  // namespace corridor::simulation
