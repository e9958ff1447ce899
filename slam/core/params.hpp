// Parameters: one plain struct per algorithm, defaults in the struct and nowhere else.
// A parameter struct P has a static `void visit(P& params, V&& visitor)` that calls
// `visitor(ParamInfo, field)` for each field; help, tables, dumps, overrides and range checks
// follow from that one list. It may add `std::vector<std::string> relations() const` for rules
// across fields.
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <concepts>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "slam/core/result.hpp"

namespace corridor {

struct ParamInfo {
  std::string_view name;                                  // snake_case with its unit
  std::string_view unit;                                  // "m", "rad", "1", "" for none
  std::string_view meaning;                               // what it does and when to change it
  double min = -std::numeric_limits<double>::infinity();  // inclusive; numbers only
  double max = std::numeric_limits<double>::infinity();
};

// Text form of every value, by name: what a result record stores.
using ParamValues = std::map<std::string, std::string>;

struct ParamRow {
  std::string name, type, value, unit, range, meaning;
};

namespace detail {

inline std::string to_text(bool value) { return value ? "true" : "false"; }
inline std::string to_text(const std::string& value) { return value; }
inline std::string to_text(std::integral auto value) { return fmt::format("{}", value); }
inline std::string to_text(double value) { return fmt::format("{}", value); }

template <class T>
bool from_text(std::string_view text, T& value) {
  if constexpr (std::is_same_v<T, bool>) {
    if (text != "true" && text != "false") return false;
    value = text == "true";
    return true;
  } else if constexpr (std::is_same_v<T, std::string>) {
    value = text;
    return true;
  } else {
    T parsed{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parsed);
    if (error != std::errc{} || end != text.data() + text.size()) return false;
    value = parsed;
    return true;
  }
}

template <class T>
std::string_view type_name() {
  if constexpr (std::is_same_v<T, bool>)
    return "true or false";
  else if constexpr (std::is_same_v<T, std::string>)
    return "text";
  else if constexpr (std::is_integral_v<T>)
    return "integer";
  else
    return "number";
}

inline std::string range_text(const ParamInfo& info) {
  const bool has_min = std::isfinite(info.min);
  const bool has_max = std::isfinite(info.max);
  if (has_min && has_max) return fmt::format("{} to {}", info.min, info.max);
  if (has_min) return fmt::format(">= {}", info.min);
  if (has_max) return fmt::format("<= {}", info.max);
  return "";
}

}  // namespace detail

template <class P>
std::vector<ParamRow> param_table(P params = {}) {
  std::vector<ParamRow> rows;
  P::visit(params, [&](const ParamInfo& info, auto& field) {
    using T = std::remove_reference_t<decltype(field)>;
    rows.push_back({std::string(info.name), std::string(detail::type_name<T>()),
                    detail::to_text(field), std::string(info.unit), detail::range_text(info),
                    std::string(info.meaning)});
  });
  return rows;
}

template <class P>
ParamValues param_values(P params) {
  ParamValues values;
  P::visit(params, [&](const ParamInfo& info, auto& field) {
    values.emplace(std::string(info.name), detail::to_text(field));
  });
  return values;
}

// All rules broken: "name = value: expected RULE". Empty = valid.
template <class P>
std::vector<std::string> param_violations(P params) {
  std::vector<std::string> found;
  P::visit(params, [&](const ParamInfo& info, auto& field) {
    using T = std::remove_reference_t<decltype(field)>;
    if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
      const double value = static_cast<double>(field);
      if (!(value >= info.min && value <= info.max) || !std::isfinite(value)) {
        found.push_back(fmt::format(
            "{} = {}: expected {}", info.name, field,
            detail::range_text(info).empty() ? "a finite number" : detail::range_text(info)));
      }
    }
  });
  if constexpr (requires { params.relations(); }) {
    for (std::string& line : params.relations()) found.push_back(std::move(line));
  }
  return found;
}

// Sets every override and then checks everything. On failure the Error lists ALL unknown keys,
// unreadable values and broken rules, separated by "; ".
template <class P>
Result<P> with_overrides(P params, const ParamValues& overrides, std::string_view where) {
  std::vector<std::string> problems;
  ParamValues unused = overrides;
  std::string known;
  P::visit(params, [&](const ParamInfo& info, auto& field) {
    using T = std::remove_reference_t<decltype(field)>;
    known += (known.empty() ? "" : " ") + std::string(info.name);
    const auto found = overrides.find(std::string(info.name));
    if (found == overrides.end()) return;
    unused.erase(found->first);
    if (!detail::from_text(found->second, field)) {
      problems.push_back(fmt::format("{} = \"{}\": expected {}", info.name, found->second,
                                     detail::type_name<T>()));
    }
  });
  for (const auto& [name, value] : unused) {
    problems.push_back(fmt::format("unknown parameter {} (known: {})", name, known));
  }
  for (std::string& line : param_violations(params)) problems.push_back(std::move(line));
  if (problems.empty()) return params;
  return fail(ErrorCode::kInvalid, fmt::format("{}", fmt::join(problems, "; ")),
              std::string(where));
}

}  // namespace corridor
