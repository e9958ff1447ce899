// Rows of tables about pose graphs: what those about back-ends and about false closures share.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/tables/summary.hpp"

namespace corridor::tables {

// A metric without a unit, to three digits.
Metric graph_metric(const char* key, const char* name, int decimals,
                    std::function<std::optional<double>(const results::RunResult&)> value);

// Begins with the columns of a graph and of a series.
Table graph_table(const char* id, const char* caption);

void add_columns(const std::vector<Metric>& metrics, Table& table);
// `reason`: why there is none, where there is none.
void add_cells(const reports::Cases& cases, const std::string& dataset,
               const reports::Series& series, const std::vector<Metric>& metrics,
               std::vector<Cell>& row, const std::string& reason = "not measured");

// "9/9", and the interval of the share where seeds draw anything: two cells.
void add_share(const std::vector<const reports::Case*>& tried,
               bool (*is_success)(const results::RunResult&), std::vector<Cell>& row);

// Over the repeats; text, since relative gaps span ten powers of ten.
using GapOf = std::optional<double> (*)(const results::RunResult&);
Cell median_gap(const std::vector<const reports::Case*>& tried, GapOf gap_of);
Cell largest_gap(const std::vector<const reports::Case*>& tried, GapOf gap_of);

}  // namespace corridor::tables
