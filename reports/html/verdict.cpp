#include "reports/html/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "bench/statistics/quantiles.hpp"
#include "reports/metrics.hpp"
#include "reports/tables/summary.hpp"
#include "reports/tables/writers.hpp"

namespace corridor::html {
namespace {

using reports::Cases;
using reports::Series;
using tables::Estimate;
using tables::Metric;
using tables::WorldValues;

struct Entry {
  Series series;
  std::string label;
  WorldValues values;
  Estimate estimate;
};

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

std::string most_accurate(const Metric& metric, const std::vector<Entry>& entries) {
  std::vector<WorldValues> values;
  for (const Entry& entry : entries) values.push_back(entry.values);
  const Entry& first = entries.front();
  const std::string figures =
      fmt::format("{} over {} of {} worlds", with_unit(first.estimate, metric.unit),
                  first.estimate.n, first.estimate.of);
  if (entries.size() == 1) {
    return fmt::format("The {} was measured for {} only: {}.", metric.name, first.label, figures);
  }
  if (tables::clearly_smallest(values) == std::size_t{0}) {
    return fmt::format(
        "{} has the smallest {} of {} systems, and its lead over each of them is shown "
        "to be real: median {}.",
        first.label, metric.name, entries.size(), figures);
  }
  return fmt::format(
      "{} has the smallest median {} of {} systems, {}, but its lead over every other "
      "one is not shown to be real.",
      first.label, metric.name, entries.size(), figures);
}

// "karto 0.051 [0.048, 0.057] over 10 worlds (smaller)".
std::string factor_text(const Entry& system, const Entry& rival) {
  const auto ratio = tables::compare_worlds(rival.values, system.values);
  if (!ratio) {
    return fmt::format("{} not compared (fewer than {} common worlds)", rival.label,
                       tables::kMinValuesForInterval);
  }
  return fmt::format("{} {:.3f} [{:.3f}, {:.3f}] over {} worlds ({})", rival.label, ratio->value,
                     ratio->low, ratio->high, ratio->num_values,
                     ratio->high < 1  ? "smaller"
                     : ratio->low > 1 ? "larger"
                                      : "no difference shown");
}

bool is_fusion(const Series& series) {
  return series.system == "fusion" || series.system == "fusion-paper";
}

bool is_rival(const Series& series) {
  return series.system == "karto" || series.system == "gmapping";
}

void append_trajectory_verdicts(const Cases& cases, const std::string& dataset,
                                std::vector<std::string>& sentences) {
  for (const Metric& metric : {reports::position_error(), reports::angle_error()}) {
    const std::vector<Entry> entries = entries_by_median(cases, dataset, metric);
    if (entries.empty()) continue;
    sentences.push_back(most_accurate(metric, entries));
    for (const Entry& system : entries) {
      if (!is_fusion(system.series)) continue;
      std::string factors;
      for (const Entry& rival : entries) {
        if (!is_rival(rival.series)) continue;
        factors += (factors.empty() ? "" : ", ") + factor_text(system, rival);
      }
      if (factors.empty()) continue;
      sentences.push_back(fmt::format("The {} of {} as a factor of its rivals': {}.", metric.name,
                                      system.label, factors));
    }
  }
}

// "is too short: measured - true = -0.431 m [-0.450, -0.421] (8 of 8 worlds)".
std::string length_error(const Estimate& estimate) {
  const bool is_clear = estimate.low && estimate.high && *estimate.low * *estimate.high > 0;
  return fmt::format("{}: measured - true = {} ({} of {} worlds)",
                     !is_clear             ? "is not shown to be too short or too long"
                     : estimate.median < 0 ? "is too short"
                                           : "is too long",
                     with_unit(estimate, "m"), estimate.n, estimate.of);
}

// How long the corridor's arms become on the map: the subject of the paper's table 1.
void append_map_verdicts(const Cases& cases, const std::string& dataset,
                         std::vector<std::string>& sentences) {
  using reports::KeyVariable;
  using reports::MapKind;
  for (const Series& series : cases.series()) {
    if (!is_fusion(series) && !is_rival(series)) continue;
    std::string parts;
    for (const KeyVariable variable : {KeyVariable::kA, KeyVariable::kB}) {
      Metric error = reports::key_measured(variable, MapKind::kOwn);
      error.value = [measured = error.value,
                     truth = reports::key_true(variable, MapKind::kOwn).value](
                        const results::RunResult& result) -> std::optional<double> {
        const auto m = measured(result);
        const auto t = truth(result);
        if (!m || !t) return std::nullopt;
        return *m - *t;
      };
      const tables::Cell cell = tables::summarise(cases, dataset, series, error, "not measurable");
      const auto* estimate = std::get_if<Estimate>(&cell);
      if (estimate == nullptr && std::get<tables::Missing>(cell).reason == "not run") continue;
      parts +=
          fmt::format("{}{} {}", parts.empty() ? "" : "; ", reports::name_of(variable),
                      estimate == nullptr ? tables::plain_text(cell) : length_error(*estimate));
    }
    const auto has_truth = [&](const reports::Case* entry) {
      return entry->result.own_map.key_distances.has_value();
    };
    const auto all = cases.of(dataset, series);
    if (!parts.empty() && std::any_of(all.begin(), all.end(), has_truth)) {
      sentences.push_back(fmt::format("On {}'s own map {}.", cases.label(series), parts));
    }
  }
}

void append_relation_verdict(const Cases& cases, const std::string& dataset,
                             std::vector<std::string>& sentences) {
  const Metric metric = reports::relation_translation_mean();
  const std::vector<Entry> entries = entries_by_median(cases, dataset, metric);
  if (entries.empty()) return;
  const Entry& first = entries.front();
  const Entry& last = entries.back();
  sentences.push_back(fmt::format("{}: mean relation error from {} ({}) to {} ({}), {} systems.",
                                  dataset, with_unit(first.estimate, "m"), first.label,
                                  with_unit(last.estimate, "m"), last.label, entries.size()));
}

std::string outcome_sentence(const Cases& cases) {
  std::map<std::string, int> counts;
  int num_not_ok = 0;
  for (const reports::Case& entry : cases.all()) {
    if (entry.result.status == results::CaseStatus::kOk) continue;
    ++num_not_ok;
    ++counts[results::to_text(entry.result.status)];
  }
  if (num_not_ok == 0) return fmt::format("All {} cases ended with status ok.", cases.all().size());
  std::string parts;
  for (const auto& [status, count] : counts) {
    parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", count, status);
  }
  return fmt::format("{} of {} cases did not end with status ok: {}.", num_not_ok,
                     cases.all().size(), parts);
}

}  // namespace

std::vector<Verdict> verdicts(const Cases& cases) {
  std::vector<Verdict> all;
  for (const std::string& dataset : cases.datasets()) {
    Verdict verdict{dataset, {}};
    append_trajectory_verdicts(cases, dataset, verdict.sentences);
    append_map_verdicts(cases, dataset, verdict.sentences);
    append_relation_verdict(cases, dataset, verdict.sentences);
    if (!verdict.sentences.empty()) all.push_back(std::move(verdict));
  }
  all.push_back({"All cases", {outcome_sentence(cases)}});
  return all;
}

}  // namespace corridor::html
