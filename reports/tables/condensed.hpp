// A table as people read it: what is the same in every row is said once, above the table.
// CSV keeps every column (writers.hpp).
#pragma once

#include <string>

#include "reports/tables/table.hpp"

namespace corridor::tables {

struct Condensed {
  Table table;         // without the columns that say the same in every row
  std::string common;  // "In every row: data set: paper-corridor; map: own." or ""
};

// Columns of estimates stay, and so does at least one column; of a table of one row only optional
// columns without a value go.
Condensed condense(const Table& table);

}  // namespace corridor::tables
