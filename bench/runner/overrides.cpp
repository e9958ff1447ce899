#include "bench/runner/overrides.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "slam/core/nearest_names.hpp"

namespace corridor::runner {

Result<ParamValues> resolve_overrides(const SystemInfo& info, const std::string& profile,
                                      const ParamValues& overrides) {
  std::vector<std::string> names;
  for (const ParamRow& row : info.param_table(profile)) names.push_back(row.name);
  ParamValues known;
  std::vector<std::string> problems;
  for (const auto& [name, value] : overrides) {
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      known.emplace(name, value);
      continue;
    }
    problems.push_back(fmt::format("unknown parameter {} (nearest: {})", name,
                                   fmt::join(nearest_names(name, names), ", ")));
  }
  Result<ParamValues> values = info.resolve(profile, known);
  if (problems.empty()) return values;
  if (!values) problems.push_back(values.error().what);
  return fail(ErrorCode::kInvalid, fmt::format("{}", fmt::join(problems, "; ")),
              "system " + info.name, "one of `corridor-bench list profiles --json`");
}

}  // namespace corridor::runner
