#include "reports/tables/report_tables.hpp"

#include "reports/false_closures.hpp"

namespace corridor::tables {

std::vector<Table> report_tables(const reports::Cases& cases) {
  const reports::Cases logs = cases.of_logs();
  const reports::Cases graphs = cases.of_graphs();
  const reports::Cases true_graphs = reports::without_false_closures(graphs);
  std::vector<Table> tables = {key_distance_table(logs),
                               key_distance_error_table(logs),
                               trajectory_error_table(logs),
                               comparison_table(logs),
                               consistency_table(logs),
                               detection_table(logs),
                               relation_table(logs),
                               back_end_table(true_graphs),
                               back_end_ratio_table(true_graphs),
                               back_end_run_table(true_graphs),
                               false_closure_table(reports::with_false_closures(graphs)),
                               cost_table(logs),
                               stage_table(logs),
                               outcome_table(cases),
                               failure_table(cases),
                               missing_table(logs)};
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  return tables;
}

}  // namespace corridor::tables
