// Pose graphs: the time of every back-end as a share of Ceres', repeat by repeat.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "reports/graph_cases.hpp"
#include "reports/tables/graph_rows.hpp"
#include "reports/tables/report_tables.hpp"
#include "reports/tables/summary.hpp"
#include "reports/timing.hpp"

namespace corridor::tables {
namespace {

using reports::Cases;
using reports::Series;
using results::RunResult;

// At once. Of these starts the first from which either reference solves the graph: odometry is what
// anyone would begin with, from chordal relaxation hard graphs are solved as well, and graphs that
// systems make have the values that their system gave.
constexpr const char* kReferenceSystem = "graph-batch";
constexpr std::array<const char*, 3> kReferenceProfiles = {"odometry", "chordal", "file"};
constexpr std::array<const char*, 2> kReferenceBackEnds = {"ceres", "ceres@tuned"};

// Times of what was solved.
WorldValues solved_times(const Cases& cases, const std::string& dataset, const Series& series) {
  const Metric metric =
      graph_metric("wall_s", "total [s]", 4, [](const RunResult& r) -> std::optional<double> {
        return reports::is_solved(r) ? r.wall_s : std::nullopt;
      });
  return world_values(cases, dataset, series, metric);
}

struct Reference {
  bool was_run = false;
  WorldValues times;  // of what was solved
};

Reference reference_of(const Cases& cases, const std::string& dataset, const std::string& profile,
                       const char* back_end) {
  for (const Series& series : cases.series()) {
    if (series.system != kReferenceSystem || series.profile != profile) continue;
    if (series.backend != back_end || !series.overrides.empty()) continue;
    if (num_worlds(cases, dataset, series) == 0) continue;
    return {true, solved_times(cases, dataset, series)};
  }
  return {};
}

std::string reference_profile(const Cases& cases, const std::string& dataset) {
  for (const char* profile : kReferenceProfiles) {
    for (const char* back_end : kReferenceBackEnds) {
      if (!reference_of(cases, dataset, profile, back_end).times.empty()) return profile;
    }
  }
  return kReferenceProfiles.front();
}

Cell ratio_cell(const Reference& reference, const WorldValues& times) {
  if (!reference.was_run) return Missing{"reference not run"};
  if (reference.times.empty()) return Missing{"reference solved nothing"};
  const auto ratio = compare_worlds(reference.times, times);
  if (!ratio) return Missing{fmt::format("fewer than {} pairs", kMinValuesForInterval)};
  const int num_pairs = static_cast<int>(ratio->num_values);
  return Estimate{ratio->value, ratio->low, ratio->high, num_pairs, num_pairs};
}

}  // namespace

Table back_end_ratio_table(const Cases& cases) {
  Table table = graph_table(
      "backend-ratios",
      "Pose graphs: total time until solved over that of Ceres at once in the same repeat; "
      "median over repeats [95 % bootstrap "
      "interval of the median]");
  table.columns.push_back({"start of the reference", "reference_start", ColumnKind::kText});
  for (const char* back_end : kReferenceBackEnds) {
    table.columns.push_back({fmt::format("time / {}", back_end), fmt::format("ratio_{}", back_end),
                             ColumnKind::kEstimate, true});
  }
  for (const std::string& dataset : cases.datasets()) {
    const std::string profile = reference_profile(cases, dataset);
    std::array<Reference, kReferenceBackEnds.size()> references;
    std::transform(kReferenceBackEnds.begin(), kReferenceBackEnds.end(), references.begin(),
                   [&](const char* name) { return reference_of(cases, dataset, profile, name); });
    if (std::none_of(references.begin(), references.end(),
                     [](const Reference& reference) { return reference.was_run; })) {
      continue;
    }
    for (const Series& series : cases.series()) {
      const WorldValues times = solved_times(cases, dataset, series);
      if (times.empty()) continue;
      std::vector<Cell> row = {dataset, cases.label(series), profile};
      for (const Reference& reference : references) row.push_back(ratio_cell(reference, times));
      table.rows.push_back(std::move(row));
    }
  }
  table.notes = reports::timing_notes(cases);
  table.notes.emplace_back(
      "The reference starts from odometry; where it solves nothing from there, from chordal "
      "relaxation; of graphs that systems make, from the values that their system gave.");
  table.notes.emplace_back(
      "Each back-end until its own rule stops it, below the limit of \"solved\": ceres at a "
      "relative decrease of 1e-6, its default, all others at 1e-9. Pose by pose the "
      "whole run with every pose read when it is the newest. Rows of what solved nothing are in "
      "the table of back-ends. Ceres is the library that Debian ships, built for any x86-64: "
      "building it for x86-64-v3, as our "
      "code is, gains it nothing (slam/backend/ceres).");
  return table;
}

}  // namespace corridor::tables
