#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>

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

Result<void> add_overrides(Suite& suite, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    const std::size_t dot = text.find('.');
    const std::size_t equal = text.find('=');
    if (dot == std::string::npos || equal == std::string::npos || equal < dot) {
      return fail(ErrorCode::kInvalid, fmt::format("\"{}\" cannot be read", text), "--set",
                  "SYSTEM.key=value");
    }
    suite.overrides[text.substr(0, dot)][text.substr(dot + 1, equal - dot - 1)] =
        text.substr(equal + 1);
  }
  for (const auto& [system, params] : suite.overrides) {
    const Result<SystemInfo> info = find_system(system);
    if (!info) return fail(info.error().code, info.error().what, "--set", info.error().expected);
    for (const SystemChoice& choice : suite.systems) {
      if (choice.system != system) continue;
      const Result<ParamValues> values = resolve_overrides(*info, choice.profile, params);
      if (!values) return fail(ErrorCode::kInvalid, values.error().to_line(), "--set");
    }
  }
  return {};
}

}  // namespace corridor::runner
