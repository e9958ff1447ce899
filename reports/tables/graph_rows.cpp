#include "reports/tables/graph_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bench/statistics/quantiles.hpp"
#include "bench/statistics/wilson.hpp"
#include "reports/graph_cases.hpp"

namespace corridor::tables {
namespace {

using reports::Case;
using reports::Cases;
using reports::Series;
using results::RunResult;

constexpr int kDigits = 3;

std::vector<double> gaps_of(const std::vector<const Case*>& tried, GapOf gap_of) {
  std::vector<double> gaps;
  for (const Case* entry : tried) {
    if (const std::optional<double> gap = gap_of(entry->result)) gaps.push_back(*gap);
  }
  return gaps;
}

Cell gap_cell(const std::optional<double>& gap_ratio) {
  if (!gap_ratio) return Missing{"none"};
  return fmt::format("{:.1e}", *gap_ratio);
}

}  // namespace

Metric graph_metric(const char* key, const char* name, int decimals,
                    std::function<std::optional<double>(const RunResult&)> value) {
  return {key, name, "", decimals, std::move(value), kDigits};
}

Table graph_table(const char* id, const char* caption) {
  Table table;
  table.id = id;
  table.caption = caption;
  table.columns = {{"graph", "dataset", ColumnKind::kText},
                   {"mode and back-end", "system", ColumnKind::kText}};
  return table;
}

void add_columns(const std::vector<Metric>& metrics, Table& table) {
  for (const Metric& metric : metrics) {
    table.columns.push_back({metric.name, metric.key, ColumnKind::kEstimate, true});
  }
}

void add_cells(const Cases& cases, const std::string& dataset, const Series& series,
               const std::vector<Metric>& metrics, std::vector<Cell>& row,
               const std::string& reason) {
  for (const Metric& metric : metrics) {
    row.push_back(summarise(cases, dataset, series, metric, reason));
  }
}

void add_share(const std::vector<const Case*>& tried, bool (*is_success)(const RunResult&),
               std::vector<Cell>& row) {
  const auto num_successes =
      std::count_if(tried.begin(), tried.end(),
                    [is_success](const Case* entry) { return is_success(entry->result); });
  const auto num_tried = static_cast<std::int64_t>(tried.size());
  row.emplace_back(fmt::format("{}/{}", num_successes, num_tried));
  if (std::none_of(tried.begin(), tried.end(),
                   [](const Case* entry) { return reports::is_drawn(entry->result); })) {
    row.emplace_back(Missing{"nothing drawn"});
    return;
  }
  const auto interval = statistics::wilson_interval(num_successes, num_tried);
  row.emplace_back(fmt::format("{:.2f} to {:.2f}", interval->low, interval->high));
}

Cell median_gap(const std::vector<const Case*>& tried, GapOf gap_of) {
  return gap_cell(statistics::median(gaps_of(tried, gap_of)));
}

Cell largest_gap(const std::vector<const Case*>& tried, GapOf gap_of) {
  return gap_cell(statistics::percentile(gaps_of(tried, gap_of), 100));
}

}  // namespace corridor::tables
