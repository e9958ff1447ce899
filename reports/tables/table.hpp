// One table, whatever it is written as: columns, rows of typed cells, a caption and notes.
// It does not know Markdown, CSV, LaTeX or HTML (writers.hpp) nor where the numbers come from.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace corridor::tables {

// A median with the 95 % bootstrap interval of the median.
struct Estimate {
  double median = 0;
  std::optional<double> low, high;  // absent where there are too few values, or all are the same
  int n = 0;                        // values behind it
  int of = 0;                       // values there could have been
  int decimals = 3;      // when written for people, below 0 rounded to tens; CSV has every digit
  bool is_best = false;  // the difference to every rival is shown to be real
  bool is_published = false;  // another's figure of one run, not run here
};

struct Number {
  double value = 0;
  int decimals = 3;
};

// Not measured, and why: "not measurable (0 of 10)", "not given", "no truth".
struct Missing {
  std::string reason;
};

using Cell = std::variant<Missing, std::string, Number, Estimate>;

enum class ColumnKind {
  kText,
  kNumber,    // Number, text or Missing
  kEstimate,  // Estimate or Missing: five columns in CSV
};

struct Column {
  std::string heading;  // for people, with its unit
  std::string key;      // for programs: snake_case with its unit; CSV header
  ColumnKind kind = ColumnKind::kText;
  bool is_optional = false;  // for people left out without a word where no row has a value
  bool is_kept = false;      // for people in the table even if it is the same in every row
};

// Invariant: every row has one cell per column.
struct Table {
  std::string id;       // file name without suffix and anchor in the page
  std::string caption;  // what is compared, over what, in which unit
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
  std::vector<std::string> notes;
  bool is_detail = false;  // folded on the page
};

}  // namespace corridor::tables
