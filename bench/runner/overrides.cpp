#include "bench/runner/overrides.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "slam/core/nearest_names.hpp"

namespace corridor::runner {

Result<Override> parse_override(const std::string& text) {
  const std::size_t dot = text.find('.');
  const std::size_t equal = text.find('=');
  if (dot == std::string::npos || equal == std::string::npos || equal < dot) {
    return fail(ErrorCode::kInvalid, fmt::format("\"{}\" cannot be read", text), "--set",
                "NAME.key=value, NAME a system or back-end");
  }
  return Override{text.substr(0, dot), text.substr(dot + 1, equal - dot - 1),
                  text.substr(equal + 1)};
}

CaseOverrides split_overrides(const ParamValues& overrides,
                              const std::optional<std::string>& back_end) {
  CaseOverrides parts;
  const std::string prefix = back_end.value_or("") + ".";
  for (const auto& [name, value] : overrides) {
    if (back_end && name.starts_with(prefix)) {
      parts.back_end.emplace(name.substr(prefix.size()), value);
    } else {
      parts.system.emplace(name, value);
    }
  }
  return parts;
}

std::vector<std::string> take_unknown(const std::vector<ParamRow>& table, ParamValues& overrides) {
  std::vector<std::string> names;
  for (const ParamRow& row : table) names.push_back(row.name);
  std::vector<std::string> problems;
  for (auto it = overrides.begin(); it != overrides.end();) {
    if (std::find(names.begin(), names.end(), it->first) != names.end()) {
      ++it;
      continue;
    }
    problems.push_back(fmt::format("unknown parameter {} (nearest: {})", it->first,
                                   fmt::join(nearest_names(it->first, names), ", ")));
    it = overrides.erase(it);
  }
  return problems;
}

Result<ParamValues> resolve_overrides(const SystemInfo& info, const std::string& profile,
                                      const ParamValues& overrides) {
  return with_nearest_names(info.param_table(profile), overrides, "system " + info.name,
                            "one of `corridor-bench list profiles --json`",
                            [&](const ParamValues& known) { return info.resolve(profile, known); });
}

}  // namespace corridor::runner
