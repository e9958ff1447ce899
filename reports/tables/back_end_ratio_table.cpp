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

// At once, from odometry: what anyone would do with the graph.
constexpr const char* kReferenceSystem = "graph-batch";
constexpr const char* kReferenceProfile = "odometry";
constexpr std::array<const char*, 2> kReferenceBackEnds = {"ceres", "ceres@tuned"};

// Times of what was solved.
WorldValues solved_times(const Cases& cases, const std::string& dataset, const Series& series) {
  const Metric metric =
      graph_metric("wall_s", "total [s]", 4, [](const RunResult& r) -> std::optional<double> {
        return reports::is_solved(r) ? r.wall_s : std::nullopt;
      });
  return world_values(cases, dataset, series, metric);
}

WorldValues reference_times(const Cases& cases, const std::string& dataset, const char* back_end) {
  for (const Series& series : cases.series()) {
    if (series.system != kReferenceSystem || series.profile != kReferenceProfile) continue;
    if (series.backend == back_end && series.overrides.empty()) {
      return solved_times(cases, dataset, series);
    }
  }
  return {};
}

Cell ratio_cell(const WorldValues& reference, const WorldValues& times) {
  if (reference.empty()) return Missing{"reference solved nothing"};
  const auto ratio = compare_worlds(reference, times);
  if (!ratio) return Missing{fmt::format("fewer than {} pairs", kMinValuesForInterval)};
  const int num_pairs = static_cast<int>(ratio->num_values);
  return Estimate{ratio->value, ratio->low, ratio->high, num_pairs, num_pairs};
}

}  // namespace

Table back_end_ratio_table(const Cases& cases) {
  Table table = graph_table(
      "backend-ratios",
      "Pose graphs: total time until solved over that of Ceres at once from odometry in the same "
      "repeat; median over repeats [95 % bootstrap interval of the median]");
  for (const char* back_end : kReferenceBackEnds) {
    table.columns.push_back({fmt::format("time / {}", back_end), fmt::format("ratio_{}", back_end),
                             ColumnKind::kEstimate, true});
  }
  for (const std::string& dataset : cases.datasets()) {
    std::array<WorldValues, kReferenceBackEnds.size()> references;
    std::transform(kReferenceBackEnds.begin(), kReferenceBackEnds.end(), references.begin(),
                   [&](const char* name) { return reference_times(cases, dataset, name); });
    for (const Series& series : cases.series()) {
      const WorldValues times = solved_times(cases, dataset, series);
      if (times.empty()) continue;
      std::vector<Cell> row = {dataset, cases.label(series)};
      for (const WorldValues& reference : references) row.push_back(ratio_cell(reference, times));
      table.rows.push_back(std::move(row));
    }
  }
  table.notes = reports::timing_notes(cases);
  table.notes.emplace_back(
      "Each back-end until its own rule stops it, below the limit of \"solved\"; pose by pose the "
      "whole run with the newest pose read after every update. Rows of what solved nothing are in "
      "the table of back-ends.");
  return table;
}

}  // namespace corridor::tables
