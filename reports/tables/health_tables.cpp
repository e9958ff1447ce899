// What systems know of themselves: their own uncertainty, and the state of their sensors.
#include <fmt/format.h>

#include "reports/metrics.hpp"
#include "reports/tables/report_tables.hpp"
#include "reports/tables/summary.hpp"
#include "slam/core/chi_squared.hpp"

namespace corridor::tables {
namespace {

using reports::Cases;
using reports::Series;

constexpr int kDegreesOfFreedom = 3;      // of a pose
constexpr double kOutside_ratio = 0.025;  // on either side of a 95 % interval

struct Interval {
  double low, high;
};

// Of the mean of n values of a consistent estimator: their sum has a chi-square distribution.
Interval consistent_interval(int n) {
  return {chi_squared_quantile(kOutside_ratio, kDegreesOfFreedom * n) / n,
          chi_squared_quantile(1 - kOutside_ratio, kDegreesOfFreedom * n) / n};
}

double mean_of(const WorldValues& values) {
  double sum = 0;
  for (const auto& [world, value] : values) sum += value;
  return sum / static_cast<double>(values.size());
}

std::string verdict_on(double mean, const Interval& interval) {
  if (mean > interval.high) return "too sure of itself";
  if (mean < interval.low) return "too careful";
  return "consistent";
}

}  // namespace

Table consistency_table(const Cases& cases) {
  Table table;
  table.id = "consistency";
  table.caption =
      "Consistency: normalised estimation error squared (NEES) of poses of the solved graph, mean "
      "over worlds. 3 where the covariances are right, more where they are too small";
  table.columns = {{"data set", "dataset", ColumnKind::kText},
                   {"system", "system", ColumnKind::kText},
                   {"worlds", "worlds", ColumnKind::kNumber},
                   {"last pose [1]", "mean_nees_last", ColumnKind::kNumber},
                   {"95 % interval if consistent, from [1]", "consistent_low", ColumnKind::kNumber},
                   {"to [1]", "consistent_high", ColumnKind::kNumber},
                   {"its covariance is", "verdict", ColumnKind::kText},
                   {"along the run [1]", "mean_nees_mean", ColumnKind::kNumber}};
  for (const std::string& dataset : cases.datasets()) {
    for (const Series& series : cases.series()) {
      const WorldValues last = world_values(cases, dataset, series, reports::nees_last());
      if (last.empty()) continue;
      const Interval interval = consistent_interval(static_cast<int>(last.size()));
      table.rows.push_back(
          {dataset, cases.label(series), Number{static_cast<double>(last.size()), 0},
           Number{mean_of(last), 2}, Number{interval.low, 2}, Number{interval.high, 2},
           verdict_on(mean_of(last), interval),
           Number{mean_of(world_values(cases, dataset, series, reports::nees_mean())), 2}});
    }
  }
  table.notes = {
      "e^T P^-1 e of a pose, e its error with the first poses laid on each other, P its marginal "
      "covariance in the graph that the system solved last. Worlds are independent, poses of one "
      "run are not: the interval holds for the last pose. Systems without a graph state no "
      "covariance and have no row."};
  table.is_detail = true;
  return table;
}

Table detection_table(const Cases& cases) {
  Table table;
  table.id = "detection";
  table.caption =
      "Sensor health: what the systems noticed of slipping wheels and of a LiDAR that sees no "
      "direction or only one, scan by scan against the simulator; median over worlds [95 % "
      "bootstrap interval of the median] (worlds with a value / worlds tried)";
  table.columns = {{"data set", "dataset", ColumnKind::kText},
                   {"system", "system", ColumnKind::kText}};
  const std::vector<Metric> scores = reports::detection_scores();
  for (const Metric& score : scores) {
    table.columns.push_back(
        {fmt::format("{} [{}]", score.name, score.unit), score.key, ColumnKind::kEstimate});
  }
  for (const std::string& dataset : cases.datasets()) {
    for (const Series& series : cases.series()) {
      std::vector<Cell> row = {dataset, cases.label(series)};
      bool has_score = false;
      for (const Metric& score : scores) {
        row.push_back(summarise(cases, dataset, series, score, "nothing to score"));
        has_score = has_score || std::holds_alternative<Estimate>(row.back());
      }
      if (has_score) table.rows.push_back(std::move(row));
    }
  }
  table.notes = {
      "Precision: true alarms / alarms. Recall: affected scans noticed / affected scans. Latency: "
      "mean time from a slip's begin to its first alarm. Degenerate are scans with less than 2 % "
      "of "
      "their translational information in the weaker direction. No value: no alarm was given, or "
      "there was nothing to notice. Systems that give no such flags have no row."};
  table.is_detail = true;
  return table;
}

}  // namespace corridor::tables
