// Table 2 of the paper, the paired comparison behind it, and the relation errors on recorded data.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>

#include "reports/metrics.hpp"
#include "reports/published.hpp"
#include "reports/tables/paper_world.hpp"
#include "reports/tables/report_tables.hpp"
#include "reports/tables/summary.hpp"

namespace corridor::tables {
namespace {

using reports::Cases;
using reports::Series;

// Appends one column of estimates to the rows of a data set, best value marked.
void append_metric(const Cases& cases, const std::string& dataset, const std::vector<Series>& all,
                   const Metric& metric, std::vector<std::vector<Cell>>& rows) {
  std::vector<WorldValues> values;
  for (std::size_t index = 0; index < all.size(); ++index) {
    rows[index].push_back(summarise(cases, dataset, all[index], metric));
    values.push_back(world_values(cases, dataset, all[index], metric));
  }
  if (const auto best = clearly_smallest(values)) {
    if (auto* estimate = std::get_if<Estimate>(&rows[*best].back())) estimate->is_best = true;
  }
}

Cell optional_number(std::optional<double> value, int decimals, const std::string& reason) {
  if (value) return Number{*value, decimals};
  return Missing{reason};
}

void append_paper(const Series& series, bool is_paper, bool is_counterpart,
                  std::vector<Cell>& row) {
  if (!is_paper) {
    row.insert(row.end(), {Missing{"other world"}, Missing{"other world"}});
    return;
  }
  const auto found = std::find_if(
      reports::kPaperTable2.begin(), reports::kPaperTable2.end(),
      [&](const reports::PublishedError& published) { return published.system == series.system; });
  if (!is_counterpart || found == reports::kPaperTable2.end()) {
    row.insert(row.end(), {Missing{"not given"}, Missing{"not given"}});
  } else {
    row.insert(row.end(), {Number{found->position_m, 4}, Number{found->angle_deg, 3}});
  }
}

bool has_metric(const Cases& cases, const std::string& dataset, const Metric& metric) {
  const std::vector<const reports::Case*> all = cases.of(dataset);
  return std::any_of(all.begin(), all.end(), [&](const reports::Case* entry) {
    return metric.value(entry->result).has_value();
  });
}

// What no system can be better than, where a simulated log says it.
void append_bound(const Cases& cases, const std::string& dataset, Table& table) {
  const Cell position = summarise_worlds(cases, dataset, reports::position_bound());
  if (std::holds_alternative<Missing>(position)) return;
  std::vector<Cell> row = {dataset, "Cramer-Rao bound", position,
                           summarise_worlds(cases, dataset, reports::angle_bound())};
  row.resize(table.columns.size(), Missing{"not a system"});
  table.rows.push_back(std::move(row));
}

// The series that were tried on the data set.
std::vector<Series> series_on(const Cases& cases, const std::string& dataset) {
  std::vector<Series> tried = cases.series();
  std::erase_if(tried, [&](const Series& series) { return cases.of(dataset, series).empty(); });
  return tried;
}

std::vector<std::vector<Cell>> labelled_rows(const Cases& cases, const std::string& dataset,
                                             const std::vector<Series>& all) {
  std::vector<std::vector<Cell>> rows;
  rows.reserve(all.size());
  for (const Series& series : all) rows.push_back({dataset, cases.label(series)});
  return rows;
}

// A series' factor to a rival and whether it is shown to differ from 1.
struct Factor {
  Cell factor = Missing{"not compared"};
  Cell is_different = Missing{"not compared"};
};

Factor factor_of(const Cases& cases, const std::string& dataset, const Series& system,
                 const Series& rival, const Metric& metric) {
  const auto ratio = compare_worlds(world_values(cases, dataset, rival, metric),
                                    world_values(cases, dataset, system, metric));
  if (!ratio) return {};
  const bool is_different = ratio->high < 1 || ratio->low > 1;
  return {Estimate{ratio->value, ratio->low, ratio->high, static_cast<int>(ratio->num_values),
                   num_worlds(cases, dataset, system), 3, false},
          std::string(is_different ? "yes" : "no")};
}

// Errors against another program's poses contain that program's errors.
void append_reference_note(const Cases& cases, std::vector<std::string>& notes) {
  std::set<std::string> datasets;
  for (const reports::Case& entry : cases.all()) {
    if (entry.result.true_poses == "reference") datasets.insert(entry.result.dataset);
  }
  if (datasets.empty()) return;
  notes.push_back(
      fmt::format("{}: compared with poses that the robot's own SLAM program found, a reference "
                  "with errors of its own: small differences say nothing.",
                  fmt::join(datasets, ", ")));
}

}  // namespace

Table trajectory_error_table(const Cases& cases) {
  Table table;
  table.id = "table2";
  table.caption =
      "Table 2. Position and angle error (RMSE, first poses aligned): median over worlds [95 % "
      "bootstrap interval of the median] (worlds with a value / worlds tried)";
  table.columns = {{"data set", "dataset", ColumnKind::kText},
                   {"system", "system", ColumnKind::kText},
                   {"position [m]", "position_rmse_m", ColumnKind::kEstimate},
                   {"angle [deg]", "angle_rmse_deg", ColumnKind::kEstimate},
                   {"online position [m]", "online_position_rmse_m", ColumnKind::kEstimate},
                   {"online angle [deg]", "online_angle_rmse_deg", ColumnKind::kEstimate},
                   {"worst position [m]", "worst_position_rmse_m", ColumnKind::kNumber},
                   {"worlds ended ok", "worlds_ok", ColumnKind::kText},
                   {"position in the paper [m]", "paper_position_m", ColumnKind::kNumber, true},
                   {"angle in the paper [deg]", "paper_angle_deg", ColumnKind::kNumber, true}};
  const std::array metrics = {reports::position_error(), reports::angle_error(),
                              reports::online_position_error(), reports::online_angle_error()};
  for (const std::string& dataset : cases.datasets()) {
    if (!has_metric(cases, dataset, metrics[0]) && !has_metric(cases, dataset, metrics[2]))
      continue;
    const std::vector<Series> all = series_on(cases, dataset);
    auto rows = labelled_rows(cases, dataset, all);
    for (const Metric& metric : metrics) append_metric(cases, dataset, all, metric, rows);
    for (std::size_t index = 0; index < all.size(); ++index) {
      const Series& series = all[index];
      rows[index].push_back(optional_number(worst(world_values(cases, dataset, series, metrics[0])),
                                            3, "not measured"));
      rows[index].push_back(fmt::format("{}/{}", num_ok_worlds(cases, dataset, series),
                                        num_worlds(cases, dataset, series)));
      append_paper(series, is_paper_world(cases, dataset), is_paper_counterpart(cases, series),
                   rows[index]);
    }
    table.rows.insert(table.rows.end(), rows.begin(), rows.end());
    append_bound(cases, dataset, table);
  }
  table.notes = {
      "Without the word online: the trajectory at the end of the run. online: the pose given at "
      "the time, which cannot use later data.",
      "Bold: compared world by world with each other row, the whole 95 % interval of the median "
      "ratio lies below 1, and there is a value in at least as many worlds. Not corrected for the "
      "number of comparisons.",
      fmt::format("No interval and no verdict below {} worlds. A run that ended early (partial) "
                  "gives no value and counts as not ok.",
                  kMinValuesForInterval),
  };
  append_reference_note(cases, table.notes);
  const std::vector<std::string> datasets = cases.datasets();
  if (std::any_of(datasets.begin(), datasets.end(),
                  [&](const std::string& dataset) { return is_paper_world(cases, dataset); })) {
    table.notes.emplace_back(
        "The paper's values are from one run of its own simulation and robot; its method stands "
        "beside fusion-paper, our implementation of it.");
  }
  return table;
}

Table comparison_table(const Cases& cases) {
  Table table;
  table.id = "comparison";
  table.is_detail = true;
  table.caption =
      "Paired factors: a system's error divided by a rival's in the same world, median [95 % "
      "bootstrap interval] (worlds that both have / worlds tried); below 1 the system is better";
  table.columns = {{"data set", "dataset", ColumnKind::kText},
                   {"system", "system", ColumnKind::kText},
                   {"rival", "rival", ColumnKind::kText},
                   {"position factor", "position_ratio", ColumnKind::kEstimate},
                   {"shown to differ", "is_different", ColumnKind::kText},
                   {"angle factor", "angle_ratio", ColumnKind::kEstimate},
                   {"angle shown to differ", "is_angle_different", ColumnKind::kText}};
  for (const std::string& dataset : cases.datasets()) {
    const std::vector<Series> all = series_on(cases, dataset);
    for (std::size_t index = all.size(); index-- > 0;) {
      for (std::size_t other = 0; other < index; ++other) {
        const Factor position =
            factor_of(cases, dataset, all[index], all[other], reports::position_error());
        const Factor angle =
            factor_of(cases, dataset, all[index], all[other], reports::angle_error());
        if (std::holds_alternative<Missing>(position.factor) &&
            std::holds_alternative<Missing>(angle.factor)) {
          continue;
        }
        table.rows.push_back({dataset, cases.label(all[index]), cases.label(all[other]),
                              position.factor, position.is_different, angle.factor,
                              angle.is_different});
      }
    }
  }
  table.notes = {fmt::format(
      "Each pair once; the inverse factor has the inverse interval. The intervals hold for one "
      "pair each and are not corrected for the number of pairs, {}. Fewer than {} common worlds "
      "are not "
      "compared.",
      table.rows.size(), kMinValuesForInterval)};
  return table;
}

Table relation_table(const Cases& cases) {
  Table table;
  table.id = "relations";
  table.caption =
      "Relation errors on recorded data: median over runs [95 % bootstrap interval of the median] "
      "(runs with a value / runs)";
  table.columns = {{"data set", "dataset", ColumnKind::kText},
                   {"system", "system", ColumnKind::kText}};
  const std::array metrics = {reports::relation_translation_mean(),
                              reports::relation_translation_std(),
                              reports::relation_rotation_mean(), reports::relation_rotation_std(),
                              reports::online_relation_translation_mean()};
  const std::array<std::string_view, 5> headings = {"translation mean [m]", "translation sd [m]",
                                                    "rotation mean [deg]", "rotation sd [deg]",
                                                    "online translation mean [m]"};
  for (std::size_t index = 0; index < metrics.size(); ++index) {
    table.columns.push_back(
        {std::string(headings[index]), metrics[index].key, ColumnKind::kEstimate});
  }
  for (const std::string& dataset : cases.datasets()) {
    if (!has_metric(cases, dataset, metrics[0])) continue;
    const std::vector<Series> all = series_on(cases, dataset);
    auto rows = labelled_rows(cases, dataset, all);
    for (const Metric& metric : metrics) append_metric(cases, dataset, all, metric, rows);
    for (const reports::PublishedRelations& published : reports::kPublishedRelations) {
      if (published.dataset != dataset) continue;
      rows.push_back({dataset, fmt::format("published: {}", published.method),
                      Estimate{published.translation_mean_m, {}, {}, 1, 1, 3, false, true},
                      Estimate{published.translation_std_m, {}, {}, 1, 1, 3, false, true},
                      Missing{"not given"}, Missing{"not given"}, Missing{"not given"}});
    }
    table.rows.insert(table.rows.end(), rows.begin(), rows.end());
  }
  table.notes = {
      "Relative poses set up by hand from the laser [Kuemmerle2009]; the difference of estimated "
      "and true relative pose, its translation and its absolute rotation. Published rows: same "
      "paper, one run, not run here."};
  return table;
}

}  // namespace corridor::tables
