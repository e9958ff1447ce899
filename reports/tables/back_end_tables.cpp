// Pose graphs: back-ends compared by what they reach and what it takes.
#include <fmt/format.h>

#include <algorithm>

#include "reports/graph_cases.hpp"
#include "reports/tables/graph_rows.hpp"
#include "reports/tables/report_tables.hpp"
#include "reports/tables/summary.hpp"
#include "reports/timing.hpp"

namespace corridor::tables {
namespace {

using reports::Case;
using reports::Cases;
using reports::Series;
using results::RunResult;

std::optional<double> per_update(const RunResult& r, const std::optional<std::int64_t>& total) {
  // The graph of a system has variables that are no poses.
  const std::int64_t num_poses = r.poses_expected.value_or(r.variables.value_or(0));
  if (!total || num_poses == 0) return std::nullopt;
  return static_cast<double>(*total) / static_cast<double>(num_poses);
}

std::vector<Metric> whole_metrics() {
  return {graph_metric("chi2", "chi2", 4, [](const RunResult& r) { return r.chi2; }),
          graph_metric("wall_s", "total [s]", 4, [](const RunResult& r) { return r.wall_s; }),
          graph_metric("cpu_s", "CPU [s]", 4, [](const RunResult& r) { return r.cpu_s; }),
          graph_metric("iterations", "iterations", 0,
                       [](const RunResult& r) -> std::optional<double> {
                         if (!r.iterations) return std::nullopt;
                         return static_cast<double>(*r.iterations);
                       }),
          graph_metric("factor_nonzeros", "nonzeros of L", 0,
                       [](const RunResult& r) -> std::optional<double> {
                         if (!r.factor_nonzeros) return std::nullopt;
                         return static_cast<double>(*r.factor_nonzeros);
                       }),
          graph_metric("peak_growth_mib", "memory [MiB]", 1,
                       [](const RunResult& r) { return r.peak_growth_mib; }),
          graph_metric("position_rmse_m", "position error [m]", 3,
                       [](const RunResult& r) { return r.final_scores.position_rmse_m; })};
}

std::optional<double> poses_per_update(const RunResult& r) {
  for (const results::StageTimes& stage : r.stages) {
    if (stage.name == "optimise" && stage.count > 0 && r.poses_expected) {
      return static_cast<double>(*r.poses_expected) / static_cast<double>(stage.count);
    }
  }
  return std::nullopt;
}

std::vector<Metric> run_metrics() {
  return {
      graph_metric("poses_per_update", "poses per update", 1, poses_per_update),
      graph_metric("step_mean_us", "mean [us]", 1,
                   [](const RunResult& r) { return r.step_mean_us; }),
      graph_metric("step_p50_us", "p50 [us]", 1, [](const RunResult& r) { return r.step_p50_us; }),
      graph_metric("step_p95_us", "p95 [us]", 1, [](const RunResult& r) { return r.step_p95_us; }),
      graph_metric("step_p99_us", "p99 [us]", 1, [](const RunResult& r) { return r.step_p99_us; }),
      graph_metric("step_max_us", "max [us]", 1, [](const RunResult& r) { return r.step_max_us; }),
      graph_metric("eliminated_per_pose", "eliminated per pose", 1,
                   [](const RunResult& r) { return per_update(r, r.eliminated); }),
      graph_metric("relinearised_per_pose", "relinearised per pose", 1,
                   [](const RunResult& r) { return per_update(r, r.relinearised); }),
      graph_metric("run_newest_gap_max_m", "newest pose off by at most [m]", 3,
                   [](const RunResult& r) { return r.run_newest_gap_max_m; })};
}

template <class AddRow>
void for_each_row(const Cases& cases, Table& table, bool is_pose_by_pose, AddRow&& add) {
  for (const std::string& dataset : cases.datasets()) {
    for (const Series& series : cases.series()) {
      const std::vector<const Case*> tried = cases.of(dataset, series);
      const bool fits = std::any_of(tried.begin(), tried.end(), [&](const Case* entry) {
        return !is_pose_by_pose || reports::is_pose_by_pose(entry->result);
      });
      if (!fits) continue;
      std::vector<Cell> row = {dataset, cases.label(series)};
      add(dataset, series, tried, row);
      table.rows.push_back(std::move(row));
    }
  }
}

}  // namespace

Table back_end_table(const Cases& cases) {
  Table table =
      graph_table("backends",
                  "Pose graphs: how often the best known chi2 was reached, how far off the "
                  "worst run was, and what it took; median over repeats [95 % bootstrap "
                  "interval of the median] (repeats with a value / repeats tried)");
  table.columns.push_back({"solved", "solved", ColumnKind::kText});
  table.columns.push_back({"95 % interval of the share", "solved_interval", ColumnKind::kText});
  table.columns.push_back({"largest chi2 / best - 1", "chi2_gap_ratio", ColumnKind::kText});
  const std::vector<Metric> metrics = whole_metrics();
  add_columns(metrics, table);
  for_each_row(
      cases, table, false,
      [&](const auto& dataset, const auto& series, const auto& tried, std::vector<Cell>& row) {
        add_share(tried, reports::is_solved, row);
        row.push_back(largest_gap(tried, [](const RunResult& r) { return r.chi2_gap_ratio; }));
        add_cells(cases, dataset, series, metrics, row);
      });
  table.notes = reports::timing_notes(cases);
  table.notes.push_back(fmt::format(
      "solved: status ok and chi2 within {:g} of the best known at once, within {:g} pose by pose. "
      "The best known is the catalogue's; of other graphs it is what Gauss-Newton finds from "
      "chordal relaxation and from the file's poses, of graphs that systems make (graph-of) from "
      "the system's last estimate.",
      reports::kSolvedAtOnce_ratio, reports::kSolvedPoseByPose_ratio));
  table.notes.emplace_back(
      "ceres has its default settings, which stop at a relative decrease of 1e-6: where that is "
      "above the limit of \"solved\", it is a stopping rule that failed and no method. ceres@tuned "
      "stops at 1e-9, as our own solvers do.");
  table.notes.emplace_back(
      "Total time: from the first initial value until the solution can be read; reading the file "
      "and scoring are outside. Times of runs that did not solve the graph are those of what they "
      "did instead. Memory: the peak beyond what the process had before. A value without an "
      "interval was the same in every repeat, or had fewer than six.");
  return table;
}

Table back_end_run_table(const Cases& cases) {
  Table table =
      graph_table("backend-updates",
                  "Pose graphs that come pose by pose: time of an update, work, and the gap to "
                  "the batch optimum of the graph so far; median over repeats [95 % bootstrap "
                  "interval of the median] (repeats with a value / repeats tried)");
  const std::vector<Metric> metrics = run_metrics();
  add_columns(metrics, table);
  table.columns.push_back({"gap along the run, p50", "run_gap_p50_ratio", ColumnKind::kText});
  table.columns.push_back({"gap along the run, largest", "run_gap_max_ratio", ColumnKind::kText});
  for_each_row(
      cases, table, true,
      [&](const auto& dataset, const auto& series, const auto& tried, std::vector<Cell>& row) {
        add_cells(cases, dataset, series, metrics, row);
        row.push_back(largest_gap(tried, [](const RunResult& r) { return r.run_gap_p50_ratio; }));
        row.push_back(largest_gap(tried, [](const RunResult& r) { return r.run_gap_max_ratio; }));
      });
  table.notes = reports::timing_notes(cases);
  table.notes.emplace_back(
      "An update is all that is done for its poses: predicting, adding and reading each, and the "
      "solver's update at the last; of graphs that systems make, the system's calls up to one that "
      "solves; "
      "p50, p95 and p99 are order statistics over the updates of a run. The gap is chi2 / optimum "
      "- 1 of the whole graph so far, whatever a back-end forgets of it, at checkpoints right "
      "after "
      "updates, of the solution read whole, measured in a replay that takes no time of the run: an "
      "update reads its newest poses alone, which for isam2 is less work.");
  return table;
}

}  // namespace corridor::tables
