// Scenarios by name or path: the folder of the tree, families and their members.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "datasets/simulation/scenario.hpp"
#include "datasets/simulation/toml_input.hpp"
#include "slam/core/nearest_names.hpp"

namespace corridor::simulation {
namespace {

namespace fs = std::filesystem;

struct Family {
  std::string key;
  std::vector<std::string> values;
};

// nullopt: a plain scenario.
Result<std::optional<Family>> read_family(const fs::path& path) {
  const Result<toml::table> document = parse_toml(path);
  if (!document) return tl::make_unexpected(document.error());
  const toml::node* node = document->get("family");
  if (node == nullptr) return std::optional<Family>();
  std::vector<TomlProblem> problems;
  const auto problem = [&](const toml::node& at, std::string text) {
    problems.push_back({at.source().begin.line, std::move(text)});
  };
  Family family;
  if (const toml::table* table = node->as_table()) {
    find_unknown_keys(*table, "family", {"key", "values"}, problems);
    const toml::node* key = table->get("key");
    const toml::node* values = table->get("values");
    if (key == nullptr || !read_value(*key, family.key)) {
      problem(*table, "family.key: expected a parameter, as \"lidar.range_max_m\"");
    }
    const toml::array* list = values == nullptr ? nullptr : values->as_array();
    for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
      double number = 0;
      if (read_value(*list->get(i), number)) {
        family.values.push_back(fmt::format("{}", number));
      } else {
        problem(*list->get(i), "family.values: expected numbers");
      }
    }
    if (family.values.empty()) problem(*table, "family.values: expected a list of numbers");
  } else {
    problem(*node, "family is not a table; expected [family]");
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
              fmt::format("a .toml file, or one of `list scenarios`; the nearest names: {}",
                          fmt::join(nearest_names(file, known), ", ")));
}

std::string without_member(const std::string& name_or_path) { return parts_of(name_or_path).file; }

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
  scenario->name += fmt::format("@{}", parts.member);
  return with_overrides(std::move(*scenario), {{(*family)->key, parts.member}}, path->string());
}

}  // namespace corridor::simulation
