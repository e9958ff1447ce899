// The LaTeX and HTML writers.
#include <fmt/format.h>

#include "reports/escape.hpp"
#include "reports/tables/condensed.hpp"
#include "reports/tables/writers.hpp"

namespace corridor::tables {
namespace {

using reports::escape_html;
using reports::escape_latex;

// An estimate takes two columns: the median in an S column, aligned at the point, and its interval
// with the count as text.
std::string latex_column(ColumnKind kind) {
  switch (kind) {
    case ColumnKind::kText:
      return "l";
    case ColumnKind::kNumber:
      return "S";
    case ColumnKind::kEstimate:
      return "S@{\\ }l";
  }
  return "l";
}

std::string latex_heading(const Column& column) {
  std::string heading = escape_latex(column.heading);
  if (column.kind == ColumnKind::kText) return heading;
  if (column.kind == ColumnKind::kNumber) return fmt::format("{{{}}}", heading);
  return fmt::format("\\multicolumn{{2}}{{c}}{{{}}}", heading);
}

// "[0.150, 0.240] (10/10)", without the interval where there is none.
std::string spread_text(const Estimate& estimate) {
  const std::string interval = interval_text(estimate);
  return fmt::format("{}{}({})", interval, interval.empty() ? "" : " ", count_text(estimate));
}

std::string latex_estimate(const Estimate& estimate) {
  return fmt::format("{}{} & {{\\footnotesize {}}}", estimate.is_best ? "\\bfseries " : "",
                     number_text(estimate.median, estimate.decimals),
                     escape_latex(spread_text(estimate)));
}

std::string latex_cell(const Cell& cell, ColumnKind kind) {
  if (const auto* estimate = std::get_if<Estimate>(&cell)) return latex_estimate(*estimate);
  if (const auto* number = std::get_if<Number>(&cell)) {
    return number_text(number->value, number->decimals);
  }
  std::string text = escape_latex(plain_text(cell));
  if (kind == ColumnKind::kText) return text;
  if (kind == ColumnKind::kNumber) return fmt::format("{{{}}}", text);
  return fmt::format("\\multicolumn{{2}}{{c}}{{{}}}", text);
}

// Longer texts may break anywhere; shorter ones stay on one line.
constexpr std::size_t kMaxNameBytes = 32;

std::string html_cell(const Cell& cell) {
  if (const auto* estimate = std::get_if<Estimate>(&cell)) {
    const std::string interval = interval_text(*estimate);
    return fmt::format(
        "<td class=\"number\">{}{}{}{}<small>({})</small></td>",
        estimate->is_best ? "<strong>" : "", number_text(estimate->median, estimate->decimals),
        estimate->is_best ? "</strong>" : "",
        interval.empty() ? "" : fmt::format("<small>{}</small>", interval), count_text(*estimate));
  }
  const std::string text = plain_text(cell);
  const char* kind = std::holds_alternative<Number>(cell)    ? "number"
                     : std::holds_alternative<Missing>(cell) ? "missing"
                     : text.size() > kMaxNameBytes           ? "text"
                                                             : "name";
  return fmt::format("<td class=\"{}\">{}</td>", kind, escape_html(text));
}

}  // namespace

std::string to_latex(const Table& full_table) {
  const auto [table, common] = condense(full_table);
  std::string columns;
  std::string headings;
  for (const Column& column : table.columns) {
    columns += latex_column(column.kind);
    if (!headings.empty()) headings += " & ";
    headings += latex_heading(column);
  }
  std::string text = fmt::format(
      "% Needs \\usepackage{{booktabs,siunitx,textcomp}} and \\usepackage[T1]{{fontenc}}.\n"
      "\\begin{{table}}\n\\centering\n\\caption{{{}}}\n\\label{{tab:{}}}\n"
      "\\sisetup{{detect-weight=true,table-format=-4.3}}\n"
      "\\begin{{tabular}}{{{}}}\n\\toprule\n{} \\\\\n\\midrule\n",
      escape_latex(table.caption), reports::file_name_from(table.id), columns, headings);
  for (const std::vector<Cell>& row : table.rows) {
    for (std::size_t index = 0; index < row.size(); ++index) {
      if (index > 0) text += " & ";
      text += latex_cell(row[index], table.columns[index].kind);
    }
    text += " \\\\\n";
  }
  text += "\\bottomrule\n\\end{tabular}\n";
  if (!common.empty()) {
    text += fmt::format("\\par\\smallskip{{\\footnotesize {}}}\n", escape_latex(common));
  }
  for (const std::string& note : table.notes) {
    text += fmt::format("\\par\\smallskip{{\\footnotesize {}}}\n", escape_latex(note));
  }
  return text + "\\end{table}\n";
}

std::string to_html(const Table& full_table) {
  const auto [table, common] = condense(full_table);
  const std::string id = escape_html(table.id);
  std::string text = fmt::format(
      "<h3 id=\"{0}-caption\">{1}</h3>\n{2}<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
      "aria-labelledby=\"{0}-caption\">\n<table id=\"{0}\" aria-labelledby=\"{0}-caption\">\n"
      "<thead><tr>",
      id, escape_html(table.caption),
      common.empty() ? "" : fmt::format("<p class=\"note\">{}</p>\n", escape_html(common)));
  for (const Column& column : table.columns) {
    text += fmt::format("<th scope=\"col\"{}>{}</th>",
                        column.kind == ColumnKind::kText ? "" : " class=\"number\"",
                        escape_html(column.heading));
  }
  text += "</tr></thead>\n<tbody>\n";
  for (const std::vector<Cell>& row : table.rows) {
    text += "<tr>";
    for (const Cell& cell : row) text += html_cell(cell);
    text += "</tr>\n";
  }
  text += "</tbody></table></div>\n";
  for (const std::string& note : table.notes) {
    text += fmt::format("<p class=\"note\">{}</p>\n", escape_html(note));
  }
  return text;
}

}  // namespace corridor::tables
