#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include "bench/runner/back_ends.hpp"
#include "bench/runner/overrides.hpp"
#include "bench/runner/suite.hpp"

namespace corridor::runner {

namespace fs = std::filesystem;

fs::path suites_folder() {
  const char* folder = std::getenv("CORRIDOR_BENCH_SUITES");
  return folder != nullptr && *folder != '\0' ? fs::path(folder) : fs::path(CORRIDOR_SUITES_DIR);
}

std::vector<fs::path> list_suites() {
  std::vector<fs::path> paths;
  std::error_code missing;
  for (const fs::directory_entry& entry : fs::directory_iterator(suites_folder(), missing)) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

Result<fs::path> find_suite(const std::string& name_or_path) {
  const fs::path path(name_or_path);
  if (path.extension() == ".toml") {
    if (fs::is_regular_file(path)) return path;
    return fail(ErrorCode::kNotFound, "does not exist", name_or_path, "a suite file");
  }
  std::string known;
  for (const fs::path& suite : list_suites()) {
    if (suite.stem() == name_or_path) return suite;
    known += fmt::format("{}{}", known.empty() ? "" : " ", suite.stem().string());
  }
  return fail(ErrorCode::kNotFound, fmt::format("unknown suite \"{}\"", name_or_path), "",
              "a .toml file or one of: " + known);
}

std::vector<std::string> back_ends_of(const Suite& suite) {
  std::vector<std::string> names;
  const auto add = [&names](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const SystemChoice& choice : suite.systems) {
    const Result<SystemInfo> info = find_system(choice.system);
    if (!info || !info->default_backend) continue;
    const std::vector<std::string>& own = suite.backends_for(choice);
    if (own.empty()) add(*info->default_backend);
    for (const std::string& name : own) add(name);
  }
  return names;
}

Result<void> check_overrides(const Suite& suite, const std::string& owner,
                             const ParamValues& params) {
  if (check_back_end(owner)) {
    const auto made = make_back_end(owner, {}, params);
    if (!made) return tl::make_unexpected(made.error());
    return {};
  }
  const Result<SystemInfo> info = find_system(owner);
  if (!info) {
    return fail(
        info.error().code, fmt::format(R"(unknown system or back-end "{}")", owner), "",
        fmt::format("{}; {}", info.error().expected, check_back_end(owner).error().expected));
  }
  for (const SystemChoice& choice : suite.systems) {
    if (choice.system != owner) continue;
    const Result<ParamValues> values = resolve_overrides(*info, choice.profile, params);
    if (!values) return tl::make_unexpected(values.error());
  }
  return {};
}

ParamValues overrides_of_case(const Suite& suite, const std::string& system,
                              const std::optional<std::string>& back_end) {
  ParamValues all;
  if (const auto found = suite.overrides.find(system); found != suite.overrides.end()) {
    all = found->second;
  }
  const auto found = suite.overrides.find(back_end.value_or(""));
  if (found == suite.overrides.end()) return all;
  for (const auto& [key, value] : found->second) all.emplace(found->first + "." + key, value);
  return all;
}

Result<void> add_overrides(Suite& suite, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    const Result<Override> set = parse_override(text);
    if (!set) return tl::make_unexpected(set.error());
    suite.overrides[set->owner][set->key] = set->value;
  }
  for (const auto& [owner, params] : suite.overrides) {
    const Result<void> good = check_overrides(suite, owner, params);
    if (good) continue;
    if (good.error().where.empty()) {
      return fail(good.error().code, good.error().what, "--set", good.error().expected);
    }
    return fail(ErrorCode::kInvalid, good.error().to_line(), "--set");
  }
  return {};
}

}  // namespace corridor::runner
