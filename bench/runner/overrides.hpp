// Parameters set by hand, in a suite or with --set, checked against the system they are for.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/runner/systems.hpp"

namespace corridor::runner {

// "NAME.key=value" of a system or back-end NAME.
struct Override {
  std::string owner, key, value;
};
Result<Override> parse_override(const std::string& text);

// A case's overrides, in one map so that its record says all of them: those of its back-end have
// "BACKEND." before their names, which no system's parameter has.
struct CaseOverrides {
  ParamValues system, back_end;
};
CaseOverrides split_overrides(const ParamValues& overrides,
                              const std::optional<std::string>& back_end);

// Takes the overrides out that no row has a name for; a line for each, with the names that it may
// have been meant for.
std::vector<std::string> take_unknown(const std::vector<ParamRow>& table, ParamValues& overrides);

// resolve(overrides), a Result that refuses unknown names and broken rules; here the Error for
// unknown ones says the nearest.
template <class Resolve>
auto with_nearest_names(const std::vector<ParamRow>& table, ParamValues overrides,
                        const std::string& where, const std::string& expected, Resolve resolve)
    -> decltype(resolve(overrides)) {
  std::vector<std::string> problems = take_unknown(table, overrides);
  auto values = resolve(overrides);
  if (problems.empty()) return values;
  if (!values) problems.push_back(values.error().what);
  return fail(ErrorCode::kInvalid, fmt::format("{}", fmt::join(problems, "; ")), where, expected);
}

// Every value of the system's parameters. The Error lists all unknown names, each with those it may
// have been meant for, and all broken rules.
Result<ParamValues> resolve_overrides(const SystemInfo& info, const std::string& profile,
                                      const ParamValues& overrides);

}  // namespace corridor::runner
