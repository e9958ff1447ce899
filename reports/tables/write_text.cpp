// Numbers as people read them, and the Markdown and CSV writers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/escape.hpp"
#include "reports/tables/condensed.hpp"
#include "reports/tables/writers.hpp"

namespace corridor::tables {
namespace {

using reports::escape_csv;
using reports::escape_markdown;

std::string markdown_cell(const Cell& cell) {
  std::string text = escape_markdown(plain_text(cell));
  const auto* estimate = std::get_if<Estimate>(&cell);
  if (estimate == nullptr || !estimate->is_best) return text;
  const std::string median = number_text(estimate->median, estimate->decimals);
  return fmt::format("**{}**{}", median, text.substr(median.size()));
}

std::string csv_number(std::optional<double> value) {
  return value ? fmt::format("{}", *value) : std::string();  // shortest text of the same double
}

std::string csv_estimate(const Cell& cell) {
  const auto* estimate = std::get_if<Estimate>(&cell);
  if (estimate == nullptr) return ",,,,,";
  return fmt::format("{},{},{},{},{},{}", csv_number(estimate->median), csv_number(estimate->low),
                     csv_number(estimate->high), estimate->n, estimate->of,
                     estimate->is_best ? "true" : "false");
}

std::string csv_cell(const Cell& cell, ColumnKind kind) {
  if (kind == ColumnKind::kEstimate) return csv_estimate(cell);
  if (const auto* number = std::get_if<Number>(&cell)) return csv_number(number->value);
  if (const auto* text = std::get_if<std::string>(&cell)) return escape_csv(*text);
  return {};
}

std::string csv_heading(const Column& column) {
  std::string key = escape_csv(column.key);
  if (column.kind != ColumnKind::kEstimate) return key;
  std::string heading = key;
  for (const char* suffix : {"_low", "_high", "_n", "_of", "_best"}) {
    heading += ',';
    heading += escape_csv(column.key + suffix);
  }
  return heading;
}

}  // namespace

std::string number_text(double value, int decimals) {
  const double unit = std::pow(10.0, -decimals);
  const double shown = decimals < 0 ? std::round(value / unit) * unit : value;
  const std::string text = fmt::format("{:.{}f}", shown, std::max(0, decimals));
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text.front() == '-' ? text.substr(1) : text;
}

std::string interval_text(const Estimate& estimate) {
  if (!estimate.low || !estimate.high) return {};
  return fmt::format("[{}, {}]", number_text(*estimate.low, estimate.decimals),
                     number_text(*estimate.high, estimate.decimals));
}

std::string count_text(const Estimate& estimate) {
  if (estimate.is_published) return "one run";
  return fmt::format("{}/{}", estimate.n, estimate.of);
}

std::string plain_text(const Cell& cell) {
  if (const auto* missing = std::get_if<Missing>(&cell)) return missing->reason;
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* number = std::get_if<Number>(&cell)) {
    return number_text(number->value, number->decimals);
  }
  const auto& estimate = std::get<Estimate>(cell);
  const std::string interval = interval_text(estimate);
  return fmt::format("{}{}{} ({})", number_text(estimate.median, estimate.decimals),
                     interval.empty() ? "" : " ", interval, count_text(estimate));
}

std::string to_markdown(const Table& full_table) {
  const auto [table, common] = condense(full_table);
  std::string text = fmt::format("**{}**\n\n{}|", escape_markdown(table.caption),
                                 common.empty() ? "" : escape_markdown(common) + "\n\n");
  for (const Column& column : table.columns) {
    text += fmt::format(" {} |", escape_markdown(column.heading));
  }
  text += "\n|";
  for (const Column& column : table.columns) {
    text += column.kind == ColumnKind::kText ? ":---|" : "---:|";
  }
  text += "\n";
  for (const std::vector<Cell>& row : table.rows) {
    text += "|";
    for (const Cell& cell : row) text += fmt::format(" {} |", markdown_cell(cell));
    text += "\n";
  }
  for (const std::string& note : table.notes) text += fmt::format("\n{}\n", escape_markdown(note));
  return text;
}

std::string to_csv(const Table& table) {
  std::string text;
  for (std::size_t index = 0; index < table.columns.size(); ++index) {
    if (index > 0) text += ',';
    text += csv_heading(table.columns[index]);
  }
  text += "\r\n";
  for (const std::vector<Cell>& row : table.rows) {
    for (std::size_t index = 0; index < row.size(); ++index) {
      if (index > 0) text += ',';
      text += csv_cell(row[index], table.columns[index].kind);
    }
    text += "\r\n";
  }
  return text;
}

}  // namespace corridor::tables
