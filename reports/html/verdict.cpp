#include "reports/html/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "reports/html/standing.hpp"
#include "reports/metrics.hpp"
#include "reports/tables/summary.hpp"
#include "reports/tables/writers.hpp"

namespace corridor::html {
namespace {

using reports::Cases;
using reports::Series;
using tables::Estimate;
using tables::Metric;

bool is_fusion(const Series& series) {
  return series.system == "fusion" || series.system == "fusion-paper";
}

// The floor: what wheels and gyro reach without a look at the LiDAR.
bool is_floor(const Series& series) { return series.system == "dead-reckoning-gyro"; }

void append_trajectory_verdicts(const Cases& cases, const std::string& dataset,
                                std::vector<std::string>& sentences) {
  for (const Metric& metric : {reports::position_error(), reports::angle_error()}) {
    const std::vector<Entry> entries = entries_by_median(cases, dataset, metric);
    for (std::size_t index = 0; index < entries.size(); ++index) {
      const Series& series = entries[index].series;
      if (index > 0 && !is_fusion(series) && !is_floor(series)) continue;
      sentences.push_back(standing(metric, entries, index));
    }
  }
}

// "is too short: measured - true = -0.431 m [-0.450, -0.421], n = 8 of 8".
std::string length_error(const Estimate& estimate) {
  const bool is_clear = estimate.low && estimate.high && *estimate.low * *estimate.high > 0;
  return fmt::format("{}: measured - true = {}, n = {} of {}",
                     !estimate.low         ? "has too few worlds for a verdict"
                     : !is_clear           ? "is not shown to be too short or too long"
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
  sentences.push_back(fmt::format("Mean relation error from {} ({}) to {} ({}), {} in all.",
                                  with_unit(first.estimate, "m"), first.label,
                                  with_unit(last.estimate, "m"), last.label, entries.size()));
}

// "karto on malaga: 1 of 3 timeout", for every series with a case that is not ok.
std::vector<std::string> outcome_sentences(const Cases& cases) {
  std::vector<std::string> sentences;
  std::size_t num_not_ok = 0;
  for (const std::string& dataset : cases.datasets()) {
    for (const Series& series : cases.series()) {
      const auto tried = cases.of(dataset, series);
      std::map<std::string, int> counts;
      for (const reports::Case* entry : tried) {
        if (entry->result.status == results::CaseStatus::kOk) continue;
        ++num_not_ok;
        ++counts[results::to_text(entry->result.status)];
      }
      for (const auto& [status, count] : counts) {
        sentences.push_back(fmt::format("{} on {}: {} of {} {}.", cases.label(series), dataset,
                                        count, tried.size(), status));
      }
    }
  }
  const std::size_t num = cases.all().size();
  sentences.insert(
      sentences.begin(),
      num_not_ok == 0 ? fmt::format("All {} cases ended with status ok.", num)
                      : fmt::format("{} of {} cases did not end with status ok.", num_not_ok, num));
  return sentences;
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
  all.push_back({"All cases", outcome_sentences(cases)});
  return all;
}

}  // namespace corridor::html
