#include "reports/html/verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "bench/statistics/quantiles.hpp"
#include "bench/statistics/wilson.hpp"
#include "reports/false_closures.hpp"
#include "reports/graph_cases.hpp"
#include "reports/html/claim.hpp"
#include "reports/html/standing.hpp"
#include "reports/metrics.hpp"
#include "reports/tables/summary.hpp"
#include "reports/tables/writers.hpp"
#include "slam/core/counted.hpp"

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

void append_trajectory_verdicts(const Cases& cases, Verdict& verdict) {
  for (const Metric& metric : {reports::position_error(), reports::angle_error()}) {
    const std::vector<Entry> entries = entries_by_median(cases, verdict.subject, metric);
    for (std::size_t index = 0; index < entries.size(); ++index) {
      const Series& series = entries[index].series;
      if (index > 0 && !is_fusion(series) && !is_floor(series)) continue;
      const bool is_first_question = index == 0 || is_floor(series);
      (is_first_question ? verdict.sentences : verdict.details)
          .push_back(standing(metric, entries, index));
    }
  }
}

using reports::KeyVariable;

// What a length on a series' own map is off; nullopt where it was not run or has no such length.
std::optional<tables::Cell> length_error(const Cases& cases, const std::string& dataset,
                                         const Series& series, KeyVariable variable) {
  using reports::MapKind;
  const auto has_truth = [](const reports::Case* entry) {
    return entry->result.own_map.key_distances.has_value();
  };
  const auto all = cases.of(dataset, series);
  if (!std::any_of(all.begin(), all.end(), has_truth)) return std::nullopt;
  Metric error = reports::key_measured(variable, MapKind::kOwn);
  error.value = [measured = error.value, truth = reports::key_true(variable, MapKind::kOwn).value](
                    const results::RunResult& result) -> std::optional<double> {
    const auto m = measured(result);
    const auto t = truth(result);
    if (!m || !t) return std::nullopt;
    return *m - *t;
  };
  tables::Cell cell = tables::summarise(cases, dataset, series, error, "not measurable");
  const auto* missing = std::get_if<tables::Missing>(&cell);
  if (missing != nullptr && missing->reason == "not run") return std::nullopt;
  return cell;
}

// What an interval shows of a length.
const char* claim_of(const Estimate& estimate) {
  if (!estimate.low || !estimate.high) return "has too few worlds for a verdict";
  if (*estimate.low * *estimate.high <= 0) return "is not shown to be too short or too long";
  return estimate.median < 0 ? "is too short" : "is too long";
}

// "On A's own map a is too short: measured - true = -0.431 m [-0.450, -0.421], n = 8 of 8; b ...".
void append_map_details(const Cases& cases, Verdict& verdict) {
  for (const Series& series : cases.series()) {
    std::string parts;
    for (const KeyVariable variable : {KeyVariable::kA, KeyVariable::kB}) {
      const auto cell = length_error(cases, verdict.subject, series, variable);
      if (!cell) continue;
      const auto* estimate = std::get_if<Estimate>(&*cell);
      const std::string text =
          estimate == nullptr
              ? tables::plain_text(*cell)
              : fmt::format("{}: measured - true = {}, n = {} of {}", claim_of(*estimate),
                            with_unit(*estimate, "m"), estimate->n, estimate->of);
      parts += fmt::format("{}{} {}", parts.empty() ? "" : "; ", reports::name_of(variable), text);
    }
    if (!parts.empty()) {
      verdict.details.push_back(fmt::format("On {}'s own map {}.", cases.label(series), parts));
    }
  }
}

// "On their own maps b (21 m) is too short for A (by 2.298 m) and B (by 0.362 m); is not shown to
// be too short or too long for C." How the arms shrink is the subject of the paper's table 1.
void append_map_verdict(const Cases& cases, KeyVariable variable, Verdict& verdict) {
  std::map<std::string, std::vector<std::string>> names;
  for (const Series& series : cases.series()) {
    const auto cell = length_error(cases, verdict.subject, series, variable);
    if (!cell) continue;
    const auto* estimate = std::get_if<Estimate>(&*cell);
    const std::string label = cases.label(series);
    if (estimate == nullptr) {
      names["is not measurable"].push_back(label);
      continue;
    }
    const std::string claim = claim_of(*estimate);
    const bool is_off = claim == "is too short" || claim == "is too long";
    names[claim].push_back(
        is_off ? fmt::format("{} (by {:.3f} m)", label, std::abs(estimate->median)) : label);
  }
  if (names.empty()) return;
  std::string parts;
  for (const auto& [claim, labels] : names) {
    parts += fmt::format("{} {} for {}", parts.empty() ? "" : ";", claim, fmt::join(labels, ", "));
  }
  verdict.sentences.push_back(
      fmt::format("On the systems' own maps, {}{}.", reports::name_of(variable), parts));
}

void append_relation_verdict(const Cases& cases, Verdict& verdict) {
  const Metric metric = reports::relation_translation_mean();
  const std::vector<Entry> entries = entries_by_median(cases, verdict.subject, metric);
  if (entries.empty()) return;
  const Entry& first = entries.front();
  const Entry& last = entries.back();
  verdict.sentences.push_back(fmt::format(
      "Mean relation error from {} ({}) to {} ({}), {} in all.", with_unit(first.estimate, "m"),
      first.label, with_unit(last.estimate, "m"), last.label, entries.size()));
}

// The most values that any series has of a number that the verdict speaks of.
std::size_t num_values_max(const Cases& cases, const std::string& dataset) {
  std::size_t most = 0;
  for (const Series& series : cases.series()) {
    for (const Metric& metric :
         {reports::position_error(), reports::angle_error(), reports::relation_translation_mean(),
          reports::key_measured(KeyVariable::kA, reports::MapKind::kOwn),
          reports::key_measured(KeyVariable::kB, reports::MapKind::kOwn)}) {
      most = std::max(most, tables::world_values(cases, dataset, series, metric).size());
    }
  }
  return most;
}

// One sentence where there is too little for any verdict, empty otherwise.
std::string why_no_verdict(const Cases& cases, const std::string& dataset) {
  if (!tables::is_scored(cases, dataset)) {
    return fmt::format("{}: no truth is known; look at the maps.", dataset);
  }
  const std::size_t most = num_values_max(cases, dataset);
  if (most >= static_cast<std::size_t>(tables::kMinValuesForInterval)) return "";
  if (tables::is_simulated(cases, dataset)) {
    return fmt::format("Too few worlds for a verdict ({} at most, {} are needed): see the tables.",
                       most, tables::kMinValuesForInterval);
  }
  return fmt::format(
      "Too few runs for a verdict ({} at most, {} are needed; recorded data are one world, n "
      "counts "
      "runs): see the tables.",
      most, tables::kMinValuesForInterval);
}

// That a graph is lost among false closures is what such cases are run to find out: one sentence.
std::set<std::filesystem::path> lost_among_false_closures(const Cases& cases) {
  std::set<std::filesystem::path> dirs;
  const Cases disturbed = reports::with_false_closures(cases.of_graphs());
  for (const reports::Case& entry : disturbed.all()) {
    if (entry.result.status == results::CaseStatus::kDiverged) dirs.insert(entry.dir);
  }
  return dirs;
}

// "karto on malaga: 1 of 3 timeout", for every series with a case that is not ok.
std::vector<std::string> outcome_sentences(const Cases& cases) {
  std::vector<std::string> sentences;
  const std::set<std::filesystem::path> lost = lost_among_false_closures(cases);
  if (!lost.empty()) {
    sentences.push_back(fmt::format(
        "{} of these diverged with false closures or a robust method: see table false-closures.",
        lost.size()));
  }
  std::size_t num_not_ok = 0;
  for (const std::string& dataset : cases.datasets()) {
    for (const Series& series : cases.series()) {
      const auto tried = cases.of(dataset, series);
      std::map<std::string, int> counts;
      for (const reports::Case* entry : tried) {
        if (entry->result.status == results::CaseStatus::kOk) continue;
        ++num_not_ok;
        if (lost.contains(entry->dir)) continue;
        ++counts[results::to_text(entry->result.status)];
      }
      for (const auto& [status, count] : counts) {
        sentences.push_back(fmt::format("{} on {}: {} of {} {}.", cases.label(series), dataset,
                                        count, tried.size(), status));
      }
    }
  }
  const auto num_unscored =
      std::count_if(cases.all().begin(), cases.all().end(), [&](const reports::Case& entry) {
        return entry.result.status == results::CaseStatus::kOk &&
               !tables::is_scored(cases, entry.result.dataset);
      });
  if (num_unscored > 0) {
    sentences.insert(sentences.begin(),
                     fmt::format("{} of those that ended are not scored: no true poses, no "
                                 "relations.",
                                 num_unscored));
  }
  const std::size_t num = cases.all().size();
  sentences.insert(
      sentences.begin(),
      num_not_ok == 0 ? fmt::format("All {} cases ended with status ok.", num)
                      : fmt::format("{} of {} cases did not end with status ok.", num_not_ok, num));
  return sentences;
}

// Who solved a graph every time, and which of them needed the least time. No comparison: the table
// and the performance profiles have all times.
void append_graph_verdict(const Cases& cases, Verdict& verdict) {
  const std::string& dataset = verdict.subject;
  std::size_t num_series = 0;
  std::size_t num_solved = 0;
  const Series* fastest = nullptr;
  double least_s = 0;
  const std::vector<Series> all = cases.series();
  for (const Series& series : all) {
    const auto tried = cases.of(dataset, series);
    num_series += tried.empty() ? 0 : 1;
    const bool is_solved = std::all_of(tried.begin(), tried.end(), [](const reports::Case* entry) {
      return reports::is_solved(entry->result) && entry->result.wall_s;
    });
    if (tried.empty() || !is_solved) continue;
    ++num_solved;
    std::vector<double> times_s;
    for (const reports::Case* entry : tried) times_s.push_back(*entry->result.wall_s);
    const double median_s = *statistics::median(times_s);
    if (fastest != nullptr && median_s >= least_s) continue;
    fastest = &series;
    least_s = median_s;
  }
  if (num_series == 0) return;
  verdict.sentences.push_back(
      fmt::format("Solved every time by {} of {} ways and back-ends.", num_solved, num_series));
  if (fastest != nullptr) {
    verdict.sentences.push_back(fmt::format("Least time: {}, median {:.3g} s over {}.",
                                            cases.label(*fastest), least_s,
                                            counted(cases.of(dataset, *fastest).size(), "run")));
  }
}

// The hardest that the suite has.
constexpr double kVerdictShare = 0.5;

// A method's runs with that share of false closures.
struct Recovery {
  std::string method, label;
  std::int64_t num_found = 0, num_tried = 0;
};

std::vector<Recovery> recoveries(const Cases& cases, const std::string& dataset) {
  std::vector<Recovery> all;
  for (const Series& series : cases.series()) {
    const auto tried = cases.of(dataset, series);
    if (tried.empty() || reports::false_share_of(tried.front()->result) != kVerdictShare) continue;
    const auto found = std::count_if(tried.begin(), tried.end(), [](const reports::Case* entry) {
      return reports::is_found_again(entry->result);
    });
    all.push_back({reports::method_of(tried.front()->result), cases.label(series), found,
                   static_cast<std::int64_t>(tried.size())});
  }
  const auto share = [](const Recovery& one) {
    return static_cast<double>(one.num_found) / static_cast<double>(one.num_tried);
  };
  std::stable_sort(all.begin(), all.end(), [&](const Recovery& left, const Recovery& right) {
    return share(left) > share(right);
  });
  return all;
}

// Which method kept which success. `cases` are those with_false_closures().
void append_closure_verdict(const Cases& cases, Verdict& verdict) {
  if (cases.of(verdict.subject).empty()) return;
  const std::vector<Recovery> all = recoveries(cases, verdict.subject);
  if (all.empty()) {
    verdict.sentences.push_back(
        fmt::format("No verdict on false closures: nothing was run with {:.0f} % of them.",
                    100 * kVerdictShare));
    return;
  }
  std::map<std::string, int> num_of_method;
  for (const Recovery& one : all) ++num_of_method[one.method];
  std::vector<std::string> parts;
  for (const Recovery& one : all) {
    const bool is_alone = num_of_method[one.method] == 1;
    const auto interval = statistics::wilson_interval(one.num_found, one.num_tried);
    parts.push_back(
        fmt::format("{} {} of {} [{:.2f}, {:.2f}]",
                    is_alone ? one.method : fmt::format("{} ({})", one.method, one.label),
                    one.num_found, one.num_tried, interval->low, interval->high));
  }
  verdict.sentences.push_back(fmt::format("With {:.0f} % of the closures false found again by: {}.",
                                          100 * kVerdictShare, fmt::join(parts, "; ")));
}

}  // namespace

std::vector<Verdict> verdicts(const Cases& cases) {
  std::vector<Verdict> all;
  const Cases graphs = cases.of_graphs();
  const Cases back_ends = reports::without_false_closures(graphs);
  const Cases disturbed = reports::with_false_closures(graphs);
  for (const std::string& dataset : graphs.datasets()) {
    Verdict verdict{dataset, {}, {}};
    append_graph_verdict(back_ends, verdict);
    append_closure_verdict(disturbed, verdict);
    all.push_back(std::move(verdict));
  }
  for (const std::string& dataset : cases.of_logs().datasets()) {
    Verdict verdict{dataset, {}, {}};
    if (const std::string reason = why_no_verdict(cases, dataset); !reason.empty()) {
      all.push_back({dataset, {reason}, {}});
      continue;
    }
    append_trajectory_verdicts(cases, verdict);
    for (std::string& sentence : claim_sentences(cases, dataset)) {
      verdict.sentences.push_back(std::move(sentence));
    }
    append_map_verdict(cases, KeyVariable::kA, verdict);
    append_map_verdict(cases, KeyVariable::kB, verdict);
    append_relation_verdict(cases, verdict);
    append_map_details(cases, verdict);
    if (!verdict.sentences.empty()) all.push_back(std::move(verdict));
  }
  all.push_back({"All cases", outcome_sentences(cases), {}});
  return all;
}

}  // namespace corridor::html
