#include "reports/series_labels.hpp"

#include <fmt/format.h>

#include <set>
#include <string_view>
#include <tuple>

namespace corridor::reports {
namespace {

using Parameters = std::map<std::string, std::string>;

constexpr std::size_t kMaxNamedParameters = 2;
constexpr std::size_t kMaxParameterBytes = 64;
constexpr std::size_t kHashDigits = 6;
constexpr std::size_t kRevisionDigits = 7;
constexpr std::string_view kDirty = "+dirty";

// Everything that series called by one name differ in; the parameters of those alone of which
// nothing is known to have been set by hand.
struct Variants {
  std::map<std::string, Parameters> parameters_by_hash;
  std::set<std::string> revisions;
};

std::string parameter_text(const Variants& variants, const std::string& hash) {
  std::vector<Parameters> all;
  for (const auto& [other, parameters] : variants.parameters_by_hash) all.push_back(parameters);
  const std::set<std::string> keys = differing_keys(all);
  const Parameters& own = variants.parameters_by_hash.at(hash);
  std::string text;
  for (const std::string& key : keys) {
    const auto found = own.find(key);
    text += fmt::format("{}{}={}", text.empty() ? "" : ", ", key,
                        found == own.end() ? "none" : found->second);
  }
  if (!keys.empty() && keys.size() <= kMaxNamedParameters && text.size() <= kMaxParameterBytes) {
    return text;
  }
  return fmt::format("#{}", std::string_view(hash).substr(0, kHashDigits));
}

// "at 48762d9+dirty".
std::string revision_text(const std::string& revision) {
  const bool is_dirty = revision.ends_with(kDirty);
  return fmt::format("at {}{}", revision.substr(0, kRevisionDigits),
                     is_dirty && revision.size() > kRevisionDigits ? kDirty : "");
}

// "set: use_loop_closing=false": never left out, because a system with a parameter set by hand is
// not the one that is shipped.
std::string override_text(const Series& series) {
  if (series.overrides.size() <= kMaxParameterBytes) return "set: " + series.overrides;
  return fmt::format("set by hand: #{}", series.parameters_hash.substr(0, kHashDigits));
}

std::string differences(const Variants& variants, const Series& series) {
  std::string text;
  if (!series.overrides.empty()) {
    text = override_text(series);
  } else if (variants.parameters_by_hash.size() > 1) {
    text = parameter_text(variants, series.parameters_hash);
  }
  if (variants.revisions.size() > 1) {
    text += (text.empty() ? "" : "; ") + revision_text(series.git_revision);
  }
  return text.empty() ? text : fmt::format(" ({})", text);
}

// What shortening made the same is told apart by all that is known.
void lengthen_doubles(std::map<Series, std::string>& labels) {
  std::map<std::string, int> num_by_label;
  for (const auto& [series, label] : labels) ++num_by_label[label];
  for (auto& [series, label] : labels) {
    if (num_by_label[label] == 1) continue;
    label = fmt::format("{}@{}/{} ({}#{}; at {})", series.system, series.profile, series.backend,
                        series.overrides.empty() ? "" : fmt::format("set: {}; ", series.overrides),
                        series.parameters_hash, series.git_revision);
  }
}

}  // namespace

std::set<std::string> differing_keys(const std::vector<Parameters>& all) {
  std::map<std::string, std::set<std::string>> values_by_key;
  std::map<std::string, std::size_t> num_by_key;
  for (const Parameters& parameters : all) {
    for (const auto& [key, value] : parameters) {
      values_by_key[key].insert(value);
      ++num_by_key[key];
    }
  }
  std::set<std::string> differing;
  for (const auto& [key, values] : values_by_key) {
    if (values.size() > 1 || num_by_key[key] < all.size()) differing.insert(key);
  }
  return differing;
}

std::map<Series, std::string> series_labels(const std::vector<Case>& cases) {
  std::map<std::string, std::set<std::string>> profiles;
  std::map<std::string, std::set<std::string>> backends;
  std::map<std::tuple<std::string, std::string, std::string>, Variants> variants;
  const auto name_of = [](const Series& series) {
    return std::make_tuple(series.system, series.profile, series.backend);
  };
  for (const Case& entry : cases) {
    const Series series = series_of(entry.result);
    profiles[series.system].insert(series.profile);
    backends[series.system].insert(series.backend);
    Variants& own = variants[name_of(series)];
    if (series.overrides.empty()) {
      own.parameters_by_hash.emplace(series.parameters_hash, entry.result.parameters);
    }
    own.revisions.insert(series.git_revision);
  }
  std::map<Series, std::string> labels;
  for (const Case& entry : cases) {
    const Series series = series_of(entry.result);
    labels[series] =
        fmt::format("{}{}{}{}", series.system,
                    profiles[series.system].size() > 1 ? "@" + series.profile : std::string(),
                    backends[series.system].size() > 1 ? "/" + series.backend : std::string(),
                    differences(variants[name_of(series)], series));
  }
  lengthen_doubles(labels);
  return labels;
}

}  // namespace corridor::reports
