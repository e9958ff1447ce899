// Methods against false loop closures: how often the true graph was found again, what they
// rejected, and what it took.
#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "reports/false_closures.hpp"
#include "reports/tables/graph_rows.hpp"
#include "reports/tables/report_tables.hpp"
#include "reports/timing.hpp"

namespace corridor::tables {
namespace {

using reports::Case;
using reports::Cases;
using reports::Series;
using results::RunResult;

constexpr double kPercent = 100;

std::optional<double> as_number(const std::optional<std::int64_t>& count) {
  if (!count) return std::nullopt;
  return static_cast<double>(*count);
}

std::vector<Metric> rejection_metrics() {
  return {graph_metric("false_closures", "false closures", 0,
                       [](const RunResult& r) { return as_number(r.false_closures); }),
          graph_metric("rejected_closures", "rejected", 0,
                       [](const RunResult& r) { return as_number(r.rejected_closures); }),
          graph_metric("rejection_precision", "precision", 4,
                       [](const RunResult& r) { return r.rejection_precision; }),
          graph_metric("rejection_recall", "recall", 4,
                       [](const RunResult& r) { return r.rejection_recall; }),
          graph_metric("wall_s", "total [s]", 4, [](const RunResult& r) { return r.wall_s; })};
}

// A series on a graph; all its cases have the parameters of the first.
struct Row {
  Series series;
  std::vector<const Case*> tried;
  std::string method;
  double share = 0;
};

// By method, what does nothing first, then by share.
std::vector<Row> rows_of(const Cases& cases, const std::string& dataset) {
  std::vector<Row> rows;
  for (const Series& series : cases.series()) {
    std::vector<const Case*> tried = cases.of(dataset, series);
    if (tried.empty()) continue;
    const RunResult& first = tried.front()->result;
    rows.push_back(
        {series, std::move(tried), reports::method_of(first), reports::false_share_of(first)});
  }
  const auto key = [](const Row& row) {
    return std::make_tuple(row.method != "none", row.method, row.share);
  };
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const Row& left, const Row& right) { return key(left) < key(right); });
  return rows;
}

std::vector<std::string> notes_of(const Cases& cases) {
  std::vector<std::string> notes = reports::timing_notes(cases);
  notes.push_back(fmt::format(
      "Found again: status ok (converged, not lost) and the chi2 of the true edges at most {:.0f} "
      "% "
      "above the best known, which is that of the graph without false closures. Of the true "
      "closures 1 % are rejected by chance, so that a millionth, as for back-ends, would be "
      "unfair; "
      "left out at the bound they would cost 4 %, where a loop hangs on one of them several times "
      "that. The gap leaves everyone free to draw the line elsewhere.",
      kPercent * reports::kFoundAgain_ratio));
  notes.emplace_back(
      "Precision: share of the rejected closures that were planted; recall: share of the planted "
      "that were rejected; of a kernel, closures beyond the bound at the solution count as "
      "rejected. Neither exists where nothing was planted or nothing looked for them. A planted "
      "closure may be true by chance, and a false one that was kept may bend the graph too little "
      "to count: recall shows it.");
  notes.emplace_back(
      "Total time: looking for false closures and solving. Times of runs that did not find the "
      "graph again are those of what they did instead.");
  return notes;
}

}  // namespace

Table false_closure_table(const Cases& cases) {
  Table table = graph_table(
      "false-closures",
      "Pose graphs with planted false loop closures: how often the true graph was found again, how "
      "far off, and what was rejected; median over seeds, each with its own false closures [95 % "
      "bootstrap interval of the median] (seeds with a value / seeds tried)");
  for (const auto& [heading, key] :
       {std::pair("method", "robust"),
        std::pair("share of closures that are false [%]", "share_percent"),
        std::pair("found again", "found_again"),
        std::pair("95 % interval of the share", "found_again_interval"),
        std::pair("chi2 of true edges / best - 1, median", "chi2_gap_p50_ratio"),
        std::pair("largest", "chi2_gap_max_ratio")}) {
    table.columns.push_back({heading, key, ColumnKind::kText});
  }
  const std::vector<Metric> metrics = rejection_metrics();
  add_columns(metrics, table);
  const auto gap_of = [](const RunResult& r) { return r.chi2_gap_ratio; };
  for (const std::string& dataset : cases.datasets()) {
    for (const Row& row : rows_of(cases, dataset)) {
      std::vector<Cell> cells = {dataset, cases.label(row.series), row.method,
                                 fmt::format("{:g}", kPercent * row.share)};
      add_share(row.tried, reports::is_found_again, cells);
      cells.push_back(median_gap(row.tried, gap_of));
      cells.push_back(largest_gap(row.tried, gap_of));
      add_cells(cases, dataset, row.series, metrics, cells, "none");
      table.rows.push_back(std::move(cells));
    }
  }
  table.notes = notes_of(cases);
  return table;
}

}  // namespace corridor::tables
