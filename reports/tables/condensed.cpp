#include "reports/tables/condensed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "reports/tables/writers.hpp"

namespace corridor::tables {
namespace {

bool is_constant(const Table& table, std::size_t column) {
  const std::string first = plain_text(table.rows.front()[column]);
  return std::all_of(table.rows.begin(), table.rows.end(), [&](const std::vector<Cell>& row) {
    return !std::holds_alternative<Estimate>(row[column]) && plain_text(row[column]) == first;
  });
}

bool is_missing(const Table& table, std::size_t column) {
  return std::all_of(table.rows.begin(), table.rows.end(), [&](const std::vector<Cell>& row) {
    return std::holds_alternative<Missing>(row[column]);
  });
}

template <class T>
void keep(std::vector<T>& items, const std::vector<bool>& is_kept) {
  std::vector<T> kept;
  for (std::size_t index = 0; index < items.size(); ++index) {
    if (is_kept[index]) kept.push_back(std::move(items[index]));
  }
  items = std::move(kept);
}

}  // namespace

Condensed condense(const Table& table) {
  std::vector<bool> is_kept;
  std::string common;
  for (std::size_t column = 0; column < table.columns.size(); ++column) {
    const bool is_left_out = table.columns[column].is_optional && is_missing(table, column);
    const bool is_said_once =
        !table.columns[column].is_kept && table.rows.size() > 1 && is_constant(table, column);
    is_kept.push_back(!is_left_out && !is_said_once);
    if (is_left_out || !is_said_once) continue;
    common += fmt::format("{}{}: {}", common.empty() ? "" : "; ", table.columns[column].heading,
                          plain_text(table.rows.front()[column]));
  }
  if (std::find(is_kept.begin(), is_kept.end(), true) == is_kept.end()) return {table, ""};
  Condensed condensed{table, common.empty() ? "" : fmt::format("In every row: {}.", common)};
  keep(condensed.table.columns, is_kept);
  for (std::vector<Cell>& row : condensed.table.rows) keep(row, is_kept);
  return condensed;
}

}  // namespace corridor::tables
