#include "reports/tables/report_tables.hpp"

namespace corridor::tables {

std::vector<Table> report_tables(const reports::Cases& cases) {
  std::vector<Table> tables = {key_distance_table(cases),
                               key_distance_error_table(cases),
                               trajectory_error_table(cases),
                               comparison_table(cases),
                               relation_table(cases),
                               cost_table(cases),
                               stage_table(cases),
                               outcome_table(cases),
                               failure_table(cases),
                               missing_table(cases)};
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  return tables;
}

}  // namespace corridor::tables
