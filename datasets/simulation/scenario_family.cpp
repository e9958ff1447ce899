// Families of scenarios, and where scenario files lie.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdint>

#include "datasets/simulation/scenario_file.hpp"
#include "datasets/simulation/toml_input.hpp"

namespace corridor::simulation {
namespace {

namespace fs = std::filesystem;

struct Family {
  std::string key;
  std::vector<std::string> values;

  [[nodiscard]] std::string section() const { return key.substr(0, key.find('.')); }
  [[nodiscard]] bool is_of_presets() const { return key == section() + ".preset"; }
};

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

// nullopt: a plain scenario.
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
    problems.push_back({node->source().begin.line, "family is not a table; expected [family]"});
  }
  if (!problems.empty()) return tl::make_unexpected(to_error(path, problems));
  return std::optional<Family>(std::move(family));
}

struct NameParts {
  std::string file, member;
};

// The last '@' parts a member's value from the name, unless a file has it in its name.
NameParts parts_of(const std::string& name) {
  std::error_code error;
  const std::size_t at = name.rfind('@');
  if (at == std::string::npos || fs::is_regular_file(name, error)) return {name, ""};
  return {name.substr(0, at), name.substr(at + 1)};
}

}  // namespace

std::vector<fs::path> list_scenarios() {
  std::vector<fs::path> paths;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(CORRIDOR_SCENARIO_DIR, error)) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

Result<fs::path> find_scenario(const std::string& name_or_path) {
  std::error_code error;
  const std::string file = parts_of(name_or_path).file;
  std::vector<std::string> known;
  for (const fs::path& path : list_scenarios()) {
    if (path.stem() == file) return path;
    known.push_back(path.stem().string());
  }
  if (fs::is_regular_file(file, error)) return fs::path(file);
  return fail(ErrorCode::kNotFound, "no such scenario", name_or_path,
              fmt::format("a file or one of {}", fmt::join(known, " ")));
}

Result<std::vector<std::string>> scenario_members(const std::string& name_or_path) {
  const NameParts parts = parts_of(name_or_path);
  if (!parts.member.empty()) return std::vector<std::string>{name_or_path};
  const Result<fs::path> path = find_scenario(name_or_path);
  if (!path) return tl::make_unexpected(path.error());
  const Result<std::optional<Family>> family = read_family(*path);
  if (!family) return tl::make_unexpected(family.error());
  if (!*family) return std::vector<std::string>{name_or_path};
  std::vector<std::string> members;
  for (const std::string& value : (*family)->values)
    members.push_back(fmt::format("{}@{}", name_or_path, value));
  return members;
}

Result<Scenario> load_scenario(const std::string& name_or_path) {
  const NameParts parts = parts_of(name_or_path);
  const Result<fs::path> path = find_scenario(name_or_path);
  if (!path) return tl::make_unexpected(path.error());
  Result<Scenario> scenario = read_scenario(*path);
  if (!scenario) return scenario;
  const Result<std::optional<Family>> family = read_family(*path);
  if (!family) return tl::make_unexpected(family.error());
  if (!*family && parts.member.empty()) return scenario;
  if (!*family) {
    return fail(ErrorCode::kNotFound, "the scenario has no members", name_or_path, parts.file);
  }
  const std::vector<std::string>& values = (*family)->values;
  if (std::find(values.begin(), values.end(), parts.member) == values.end()) {
    return fail(ErrorCode::kNotFound, "a family of scenarios needs one of its members",
                name_or_path, fmt::format("{}@ and one of {}", parts.file, fmt::join(values, " ")));
  }
  ParamValues overrides;
  if ((*family)->is_of_presets()) {
    scenario = read_scenario(*path, {(*family)->section(), parts.member});
    if (!scenario) return scenario;
  } else {
    overrides.emplace((*family)->key, parts.member);
  }
  scenario->name += fmt::format("@{}", parts.member);
  return with_overrides(std::move(*scenario), overrides, path->string());
}

}  // namespace corridor::simulation
