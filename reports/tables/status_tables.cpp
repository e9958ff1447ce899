// How cases ended, and what could not be measured: failure is a row, not a gap.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "reports/metrics.hpp"
#include "reports/tables/report_tables.hpp"
#include "reports/tables/summary.hpp"

namespace corridor::tables {
namespace {

using reports::Case;
using reports::Cases;
using reports::Series;
using results::CaseStatus;

constexpr std::array kStatuses = {
    CaseStatus::kOk,      CaseStatus::kPartial,     CaseStatus::kDiverged, CaseStatus::kFailed,
    CaseStatus::kTimeout, CaseStatus::kOutOfMemory, CaseStatus::kBadInput};

// More are folded: the table of outcomes above counts them.
constexpr std::size_t kMaxOpenFailures = 6;

Cell optional_count(const std::optional<std::int64_t>& count) {
  if (count) return Number{static_cast<double>(*count), 0};
  return Missing{"not measured"};
}

Cell seed_cell(const std::optional<std::uint64_t>& seed) {
  if (seed) return fmt::format("{}", *seed);
  return Missing{"recorded"};
}

// "all", the labels of the systems that have no value on the data set, or "" if each has one.
std::string systems_without(const Cases& cases, const std::string& dataset, const Metric& metric) {
  std::vector<std::string> without;
  std::size_t num_tried = 0;
  for (const Series& series : cases.series()) {
    if (cases.of(dataset, series).empty()) continue;
    ++num_tried;
    if (world_values(cases, dataset, series, metric).empty()) {
      without.push_back(cases.label(series));
    }
  }
  return without.size() == num_tried ? "all" : fmt::format("{}", fmt::join(without, ", "));
}

}  // namespace

Table outcome_table(const Cases& cases) {
  Table table;
  table.id = "outcomes";
  table.caption = "How the cases ended: number of cases";
  table.columns = {{"data set", "dataset", ColumnKind::kText},
                   {"system", "system", ColumnKind::kText},
                   {"cases", "cases", ColumnKind::kNumber}};
  for (const CaseStatus status : kStatuses) {
    const std::string name = results::to_text(status);
    table.columns.push_back({name, name, ColumnKind::kNumber});
  }
  for (const std::string& dataset : cases.datasets()) {
    for (const Series& series : cases.series()) {
      const std::vector<const Case*> found = cases.of(dataset, series);
      if (found.empty()) continue;
      std::vector<Cell> row = {dataset, cases.label(series),
                               Number{static_cast<double>(found.size()), 0}};
      for (const CaseStatus status : kStatuses) {
        const auto count = std::count_if(found.begin(), found.end(), [&](const Case* entry) {
          return entry->result.status == status;
        });
        row.emplace_back(Number{static_cast<double>(count), 0});
      }
      table.rows.push_back(std::move(row));
    }
  }
  table.notes = {
      "ok: every expected pose matched. partial: poses are missing. diverged: lost (not finite, by "
      "the system's own report, a mean relation error above 0.5 m, or a position RMSE above a "
      "quarter of the path); its errors stay in the medians. failed: error or crash."};
  return table;
}

Table failure_table(const Cases& cases) {
  Table table;
  table.id = "failures";
  table.caption = "Cases that did not end with status ok";
  table.columns = {{"data set", "dataset", ColumnKind::kText},
                   {"system", "system", ColumnKind::kText},
                   {"data seed", "data_seed", ColumnKind::kText},
                   {"system seed", "system_seed", ColumnKind::kText},
                   {"status", "status", ColumnKind::kText},
                   {"message", "status_message", ColumnKind::kText},
                   {"poses matched", "poses_matched", ColumnKind::kNumber},
                   {"poses expected", "poses_expected", ColumnKind::kNumber},
                   {"case", "case_id", ColumnKind::kText}};
  for (const Case& entry : cases.all()) {
    const results::RunResult& result = entry.result;
    if (result.status == CaseStatus::kOk) continue;
    table.rows.push_back({result.dataset, cases.label(reports::series_of(result)),
                          seed_cell(result.data_seed), fmt::format("{}", result.system_seed),
                          results::to_text(result.status), result.status_message,
                          optional_count(result.poses_matched),
                          optional_count(result.poses_expected), result.case_id});
  }
  table.is_detail = table.rows.size() > kMaxOpenFailures;
  return table;
}

Table missing_table(const Cases& cases) {
  Table table;
  table.id = "not-measured";
  table.is_detail = true;
  table.caption = "What was not measured: numbers without a value in any run of a system";
  table.columns = {{"data set", "dataset", ColumnKind::kText},
                   {"systems", "systems", ColumnKind::kText},
                   {"numbers without a value", "metrics", ColumnKind::kText}};
  for (const std::string& dataset : cases.datasets()) {
    std::map<std::string, std::vector<std::string>> metrics_by_systems;
    for (const Metric& metric : reports::headline_metrics()) {
      const std::string systems = systems_without(cases, dataset, metric);
      if (!systems.empty()) metrics_by_systems[systems].push_back(metric.key);
    }
    for (const auto& [systems, metrics] : metrics_by_systems) {
      table.rows.push_back({dataset, systems, fmt::format("{}", fmt::join(metrics, ", "))});
    }
  }
  return table;
}

}  // namespace corridor::tables
