// Table 1 of the paper and the errors behind it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "reports/metrics.hpp"
#include "reports/published.hpp"
#include "reports/tables/paper_world.hpp"
#include "reports/tables/report_tables.hpp"
#include "reports/tables/summary.hpp"

namespace corridor::tables {
namespace {

using reports::Cases;
using reports::KeyVariable;
using reports::kKeyVariables;
using reports::MapKind;
using reports::Series;

constexpr std::array kMapKinds = {MapKind::kOwn, MapKind::kRendered};
constexpr std::array<std::string_view, 4> kPaperSystems = {"karto", "fusion-paper", "fusion",
                                                           "gmapping"};

constexpr std::string_view kMrptPrefix = "mrpt-";

std::string map_name(MapKind kind) { return kind == MapKind::kOwn ? "own" : "common mapper"; }

std::vector<Series> table1_series(const Cases& cases) {
  std::vector<Series> chosen;
  for (const std::string_view system : kPaperSystems) {
    for (const Series& series : cases.series()) {
      if (series.system == system) chosen.push_back(series);
    }
  }
  return chosen;
}

Cell true_cell(const std::set<double>& values, int decimals) {
  if (values.size() == 1) return Number{*values.begin(), decimals};
  return fmt::format("{:.{}f} to {:.{}f}", *values.begin(), decimals, *values.rbegin(), decimals);
}

void mark_best(Cell& cell) {
  if (auto* estimate = std::get_if<Estimate>(&cell)) estimate->is_best = true;
}

// What MRPT's maps lack, where they are among the maps.
void append_map_note(const Cases& cases, Table& table) {
  for (const Series& series : cases.series()) {
    if (!series.system.starts_with(kMrptPrefix)) continue;
    table.notes.emplace_back(
        "MRPT's own maps keep no hit counts: their walls are fitted to occupied cells weighted by "
        "occupancy, the others' to hits, so their own-map distances are coarser. On the common "
        "mapper's maps all are measured alike.");
    return;
  }
}

std::vector<Cell> table1_row(const Cases& cases, const std::string& dataset, MapKind kind,
                             const reports::PublishedKeyValue& published) {
  const KeyVariable variable = published.variable;
  const Metric measured = key_measured(variable, kind);
  const bool has_paper = is_paper_world(cases, dataset);
  const auto paper_cell = [&](std::string_view system, double value) -> Cell {
    if (!has_paper) return Missing{"other world"};
    if (!may_stand_beside_paper(cases, system)) return Missing{"other parameters"};
    return Number{value, 3};
  };
  std::vector<Cell> row = {dataset,
                           fmt::format("{} [{}]", name_of(variable), unit_of(variable)),
                           map_name(kind),
                           true_cell(true_values(cases, dataset, variable), measured.decimals),
                           paper_cell("karto", published.karto),
                           paper_cell("fusion-paper", published.proposed)};
  const std::size_t first = row.size();
  const std::vector<Series> shown = table1_series(cases);
  for (const Series& series : shown) {
    row.push_back(summarise(cases, dataset, series, measured, "not measurable"));
  }
  // The best of all is marked, also of those that this table has no column for.
  const std::vector<Series> all = cases.series();
  std::vector<WorldValues> errors;
  errors.reserve(all.size());
  for (const Series& series : all) {
    errors.push_back(world_values(cases, dataset, series, key_absolute_error(variable, kind)));
  }
  if (const auto best = clearly_smallest(errors)) {
    const auto found = std::find(shown.begin(), shown.end(), all[*best]);
    if (found != shown.end())
      mark_best(row[first + static_cast<std::size_t>(found - shown.begin())]);
  }
  return row;
}

bool has_key_distances(const Cases& cases, const std::string& dataset) {
  return !true_values(cases, dataset, KeyVariable::kA).empty();
}

}  // namespace

Table key_distance_table(const Cases& cases) {
  Table table;
  table.id = "table1";
  table.caption =
      "Table 1. Key distances of the map: median over the worlds in which it was measurable, and "
      "only those [95 % bootstrap interval of the median] (measurable / worlds tried)";
  table.columns = {{"data set", "dataset", ColumnKind::kText},
                   {"variable", "variable", ColumnKind::kText},
                   {"map", "map", ColumnKind::kText},
                   {"true", "true", ColumnKind::kNumber},
                   {"Karto, in the paper", "paper_karto", ColumnKind::kNumber, true},
                   {"proposed, in the paper", "paper_proposed", ColumnKind::kNumber, true}};
  for (const Series& series : table1_series(cases)) {
    table.columns.push_back({cases.label(series), cases.label(series), ColumnKind::kEstimate});
  }
  for (const std::string& dataset : cases.datasets()) {
    if (!has_key_distances(cases, dataset)) continue;
    for (const MapKind kind : kMapKinds) {
      for (const auto& published : reports::kPaperTable1) {
        table.rows.push_back(table1_row(cases, dataset, kind, published));
      }
    }
  }
  table.notes = {
      "own: the map that the system handed in. common mapper: one mapper for all, fed with the "
      "scans and the system's final trajectory, so that only the trajectory differs.",
      "Bold: |measured - true|, compared world by world with each other system's (also those of "
      "the "
      "table of errors), has the whole 95 % interval of the median ratio below 1. Not corrected "
      "for "
      "the number of comparisons."};
  const std::vector<std::string> datasets = cases.datasets();
  if (std::any_of(datasets.begin(), datasets.end(),
                  [&](const std::string& dataset) { return is_paper_world(cases, dataset); })) {
    table.notes.emplace_back(
        "The paper gives no values of a, b, c and alpha for GMapping. Its values are from one "
        "run.");
  }
  return table;
}

Table key_distance_error_table(const Cases& cases) {
  Table table;
  table.id = "table1-errors";
  table.is_detail = true;
  table.caption =
      "Errors of the key distances, |measured - true|: median over the worlds in which it was "
      "measurable, and only those [95 % bootstrap interval of the median] (measurable / worlds "
      "tried)";
  table.columns = {{"data set", "dataset", ColumnKind::kText},
                   {"map", "map", ColumnKind::kText},
                   {"system", "system", ColumnKind::kText}};
  for (const KeyVariable variable : kKeyVariables) {
    const Metric metric = key_absolute_error(variable, MapKind::kOwn);
    table.columns.push_back({fmt::format("{} [{}]", name_of(variable), unit_of(variable)),
                             metric.key, ColumnKind::kEstimate});
  }
  const std::vector<Series> all = cases.series();
  for (const std::string& dataset : cases.datasets()) {
    if (!has_key_distances(cases, dataset)) continue;
    for (const MapKind kind : kMapKinds) {
      const std::size_t first_row = table.rows.size();
      for (const Series& series : all) {
        table.rows.push_back({dataset, map_name(kind), cases.label(series)});
      }
      for (const KeyVariable variable : kKeyVariables) {
        const Metric metric = key_absolute_error(variable, kind);
        std::vector<Cell> cells;
        std::vector<WorldValues> errors;
        for (const Series& series : all) {
          cells.push_back(summarise(cases, dataset, series, metric, "not measurable"));
          errors.push_back(world_values(cases, dataset, series, metric));
        }
        if (const auto best = clearly_smallest(errors)) mark_best(cells[*best]);
        for (std::size_t index = 0; index < all.size(); ++index) {
          table.rows[first_row + index].push_back(cells[index]);
        }
      }
    }
  }
  append_map_note(cases, table);
  return table;
}

}  // namespace corridor::tables
