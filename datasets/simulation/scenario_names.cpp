// Scenarios by name or path: the folder of the tree, families and their members.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "datasets/simulation/scenario_family.hpp"
#include "datasets/simulation/scenario_file.hpp"
#include "slam/core/nearest_names.hpp"

namespace corridor::simulation {
namespace {

namespace fs = std::filesystem;

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
  if (fs::exists(file, error)) {
    const bool is_folder = fs::is_directory(file, error);
    return fail(ErrorCode::kNotFound, is_folder ? "this is a folder" : "this is no regular file",
                file, "a .toml file, or the name of a scenario");
  }
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
