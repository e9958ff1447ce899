// The tables of a report, each made from all cases. A table without rows means: nothing of the kind
// ran.
#pragma once

#include <vector>

#include "reports/cases.hpp"
#include "reports/tables/table.hpp"

namespace corridor::tables {

// a, b, c and alpha as measured on the maps of Karto, fusion-paper, fusion and GMapping, beside the
// paper's table 1. One row per data set, kind of map and variable.
Table key_distance_table(const reports::Cases& cases);
// |measured - true| of the same for every system; one row per data set, kind of map and system.
Table key_distance_error_table(const reports::Cases& cases);
// Position and angle error, final and online, beside the paper's table 2; data sets with true
// poses.
Table trajectory_error_table(const reports::Cases& cases);
// Paired factors: position and angle error divided by another's, world by world; each pair once.
Table comparison_table(const reports::Cases& cases);
// Whether systems that solve a graph know how wrong they are: NEES against its chi-square interval.
Table consistency_table(const reports::Cases& cases);
// How well slips and blind directions of the LiDAR were noticed, against the simulator's truth.
Table detection_table(const reports::Cases& cases);
// Errors of relations set up by hand, beside published figures; recorded data.
Table relation_table(const reports::Cases& cases);
// Pose graphs: how often the best known chi2 was reached, the gap to it, time and memory.
Table back_end_table(const reports::Cases& cases);
// Their times over those of Ceres at once from odometry, repeat by repeat; what solved nothing has
// no row.
Table back_end_ratio_table(const reports::Cases& cases);
// The same pose by pose: time per update, work per update, gap along the run.
Table back_end_run_table(const reports::Cases& cases);
// What methods against false loop closures make of graphs with planted ones; of cases
// with_false_closures() alone.
Table false_closure_table(const reports::Cases& cases);
// Time, memory and real-time factor of whole runs.
Table cost_table(const reports::Cases& cases);
// Time per stage.
Table stage_table(const reports::Cases& cases);
// How many cases ended how.
Table outcome_table(const reports::Cases& cases);
// Every case that did not end with status ok, with its message.
Table failure_table(const reports::Cases& cases);
// What was not measured: data set, number, systems without it.
Table missing_table(const reports::Cases& cases);

// Those above that have rows, in the order of the page.
std::vector<Table> report_tables(const reports::Cases& cases);

}  // namespace corridor::tables
