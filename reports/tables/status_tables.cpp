// How cases ended, and what could not be measured: failure is a row, not a gap.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "reports/metrics.hpp"
#include "reports/tables/paper_world.hpp"
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

// Why no run of a data set has a number; empty where one that ended well could have had it.
std::string reason_for_none(const Cases& cases, const std::string& dataset, const Metric& metric) {
  const std::vector<const Case*> all = cases.of(dataset);
  const bool has_ended = std::any_of(all.begin(), all.end(), [](const Case* entry) {
    return entry->result.status == CaseStatus::kOk;
  });
  if (metric.key.find("relations") != std::string::npos) {
    if (is_simulated(cases, dataset)) return "does not apply";
    return has_ended ? "no truth known" : "";
  }
  if (!has_ended || metric.key == reports::realtime_factor().key) return "";
  const bool is_error = metric.key.find("rmse") != std::string::npos;
  if (is_error) return is_simulated(cases, dataset) ? "" : "no truth known";
  return true_values(cases, dataset, reports::KeyVariable::kA).empty() ? "does not apply" : "";
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
    table.columns.push_back({name, name, ColumnKind::kNumber, false, status == CaseStatus::kOk});
  }
  const std::vector<std::string> datasets = cases.datasets();
  const bool is_all_scored =
      std::all_of(datasets.begin(), datasets.end(),
                  [&](const std::string& dataset) { return is_scored(cases, dataset); });
  if (!is_all_scored) {
    table.columns.push_back({"ended; not scored", "not_scored", ColumnKind::kNumber, false, true});
  }
  for (const std::string& dataset : cases.datasets()) {
    for (const Series& series : cases.series()) {
      const std::vector<const Case*> found = cases.of(dataset, series);
      if (found.empty()) continue;
      std::vector<Cell> row = {dataset, cases.label(series),
                               Number{static_cast<double>(found.size()), 0}};
      // Whoever ended on data without truth is not known to be right.
      const bool has_score = is_scored(cases, dataset);
      double num_not_scored = 0;
      for (const CaseStatus status : kStatuses) {
        const auto count = std::count_if(found.begin(), found.end(), [&](const Case* entry) {
          return entry->result.status == status;
        });
        const bool is_unknown = status == CaseStatus::kOk && !has_score;
        if (is_unknown) num_not_scored = static_cast<double>(count);
        row.emplace_back(Number{is_unknown ? 0 : static_cast<double>(count), 0});
      }
      if (!is_all_scored) row.emplace_back(Number{num_not_scored, 0});
      table.rows.push_back(std::move(row));
    }
  }
  table.notes = {
      "ok: every expected pose matched. partial: poses are missing. diverged: lost (not finite, by "
      "the system's own report, a mean relation error above 0.5 m, or a position RMSE above a "
      "quarter of the path); its errors stay in the medians. failed: error or crash."};
  if (!is_all_scored) {
    table.notes.emplace_back(
        "ended; not scored: no true poses, no relations. The run came to its end, and nothing says "
        "whether its trajectory and map are right.");
  }
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
                   {"why", "why", ColumnKind::kText, false, true},
                   {"numbers without a value", "metrics", ColumnKind::kText}};
  for (const std::string& dataset : cases.datasets()) {
    std::map<std::pair<std::string, std::string>, std::vector<std::string>> metrics_by_systems;
    for (const Metric& metric : reports::headline_metrics()) {
      const std::string systems = systems_without(cases, dataset, metric);
      if (systems.empty()) continue;
      const std::string reason =
          systems == "all" ? reason_for_none(cases, dataset, metric) : std::string();
      metrics_by_systems[{systems, reason.empty() ? "not measured" : reason}].push_back(
          metric.name);
    }
    for (const auto& [key, metrics] : metrics_by_systems) {
      table.rows.push_back(
          {dataset, key.first, key.second, fmt::format("{}", fmt::join(metrics, ", "))});
    }
  }
  return table;
}

}  // namespace corridor::tables
