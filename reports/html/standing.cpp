#include "reports/html/standing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "reports/tables/writers.hpp"

namespace corridor::html {
namespace {

using reports::Cases;
using reports::Series;
using tables::Estimate;
using tables::Metric;

// More names than this are counted, and only the closest is written out.
constexpr std::size_t kMaxNames = 3;

struct Paired {
  std::string label;
  std::optional<statistics::Estimate> ratio;
};

// All others, by what the interval of the paired ratio says.
struct Groups {
  std::vector<Paired> smaller_than, alike, larger_than, not_compared;
};

Groups groups_of(const std::vector<Entry>& entries, std::size_t index) {
  Groups groups;
  for (std::size_t other = 0; other < entries.size(); ++other) {
    if (other == index) continue;
    const auto ratio = tables::compare_worlds(entries[other].values, entries[index].values);
    auto& group = !ratio            ? groups.not_compared
                  : ratio->high < 1 ? groups.smaller_than
                  : ratio->low > 1  ? groups.larger_than
                                    : groups.alike;
    group.push_back({entries[other].label, ratio});
  }
  return groups;
}

std::string ratio_text(const Paired& paired) {
  return fmt::format("ratio {:.3f} [{:.3f}, {:.3f}], n = {}", paired.ratio->value,
                     paired.ratio->low, paired.ratio->high, paired.ratio->num_values);
}

std::string names(const std::vector<Paired>& group, bool has_ratios) {
  std::string text;
  for (std::size_t k = 0; k < group.size(); ++k) {
    text += k == 0 ? "" : k + 1 == group.size() ? " and " : ", ";
    text += group[k].label;
    if (has_ratios) text += fmt::format(" ({})", ratio_text(group[k]));
  }
  return text;
}

// "that of all 8 others, closest X: ratio ..." or "that of A (ratio ...) and B (ratio ...)".
std::string group_text(const std::vector<Paired>& group, std::size_t num_others,
                       bool is_closest_largest) {
  if (group.size() <= kMaxNames) return "that of " + names(group, true);
  const auto closest =
      std::max_element(group.begin(), group.end(), [&](const Paired& left, const Paired& right) {
        return (left.ratio->value < right.ratio->value) == is_closest_largest &&
               left.ratio->value != right.ratio->value;
      });
  return fmt::format("that of {}, closest {}: {}",
                     group.size() == num_others
                         ? fmt::format("all {} others", num_others)
                         : fmt::format("{} of the {} others", group.size(), num_others),
                     closest->label, ratio_text(*closest));
}

// A lead over the worlds that both have is no lead where the others gave nothing.
std::string coverage_text(const std::vector<Entry>& entries, std::size_t index) {
  std::string labels;
  for (const Entry& other : entries) {
    if (other.values.size() <= entries[index].values.size()) continue;
    labels += (labels.empty() ? "" : ", ") + other.label;
  }
  return labels.empty() ? labels : fmt::format(" It gave a value in fewer worlds than {}.", labels);
}

std::string rank_text(std::size_t index, std::size_t num_entries) {
  if (index == 0) return fmt::format("the smallest median of {}", num_entries);
  if (index + 1 == num_entries) return fmt::format("the largest median of {}", num_entries);
  return fmt::format("median rank {} of {}", index + 1, num_entries);
}

}  // namespace

std::vector<Entry> entries_by_median(const Cases& cases, const std::string& dataset,
                                     const Metric& metric) {
  std::vector<Entry> entries;
  for (const Series& series : cases.series()) {
    const tables::Cell cell = tables::summarise(cases, dataset, series, metric);
    const auto* estimate = std::get_if<Estimate>(&cell);
    if (estimate == nullptr) continue;
    entries.push_back({series, cases.label(series),
                       tables::world_values(cases, dataset, series, metric), *estimate});
  }
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& left, const Entry& right) {
    return left.estimate.median < right.estimate.median;
  });
  return entries;
}

std::string with_unit(const Estimate& estimate, const std::string& unit) {
  const std::string interval = tables::interval_text(estimate);
  return fmt::format("{} {}{}{}", tables::number_text(estimate.median, estimate.decimals), unit,
                     interval.empty() ? "" : " ", interval);
}

std::string standing(const Metric& metric, const std::vector<Entry>& entries, std::size_t index) {
  const Entry& own = entries[index];
  const bool is_simulated = !own.values.empty() && own.values.begin()->first.data_seed.has_value();
  const std::string count =
      fmt::format("n = {} of {} {}{}", own.estimate.n, own.estimate.of,
                  is_simulated ? "world" : "run", own.estimate.of == 1 ? "" : "s");
  const std::string figure = with_unit(own.estimate, metric.unit);
  if (entries.size() == 1) {
    return fmt::format("The {} of {} is {} ({}); no other one was measured.", metric.name,
                       own.label, figure, count);
  }
  const std::size_t num_others = entries.size() - 1;
  const Groups groups = groups_of(entries, index);
  std::string comparison;
  const auto add = [&](const std::string& part) {
    comparison += (comparison.empty() ? " It is " : "; it is ") + part;
  };
  if (!groups.smaller_than.empty()) {
    add("shown to be smaller than " + group_text(groups.smaller_than, num_others, true));
  }
  if (!groups.alike.empty()) {
    add("not shown to differ from that of " + names(groups.alike, true));
  }
  if (!groups.larger_than.empty()) {
    add("shown to be larger than " + group_text(groups.larger_than, num_others, false));
  }
  if (!groups.not_compared.empty()) {
    add(fmt::format("not compared with that of {} (fewer than {} common worlds)",
                    names(groups.not_compared, false), tables::kMinValuesForInterval));
  }
  return fmt::format("The {} of {} is {} ({}, {}).{}.{}", metric.name, own.label, figure, count,
                     rank_text(index, entries.size()), comparison, coverage_text(entries, index));
}

}  // namespace corridor::html
