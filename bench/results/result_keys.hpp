// The one list of what a result record holds: every key with its unit and meaning, in the order in
// which result.json writes them. JSON, the store's columns and `list metrics` all follow from it.
// It does not read or write anything.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench/results/run_result.hpp"

namespace corridor::results {

struct ResultKey {
  std::string name;
  std::string_view unit;  // "" for none
  std::string_view meaning;
  bool is_metric = true;  // false: says what was run, not how well
};

namespace detail {

// `scores` is TrajectoryScores or const TrajectoryScores, likewise below.
void visit_trajectory(const std::string& prefix, auto& scores, auto&& v) {
  v(ResultKey{prefix + "position_rmse_m", "m", "RMSE of the position, first poses aligned"},
    scores.position_rmse_m);
  v(ResultKey{prefix + "angle_rmse_deg", "deg", "RMSE of the heading, first poses aligned"},
    scores.angle_rmse_deg);
  v(ResultKey{prefix + "ate_se2_rmse_m", "m",
              "absolute trajectory error after the best rigid alignment"},
    scores.ate_se2_rmse_m);
  v(ResultKey{prefix + "ate_se2_angle_rmse_deg", "deg",
              "heading error after the best rigid alignment"},
    scores.ate_se2_angle_rmse_deg);
  v(ResultKey{prefix + "rpe_1m_rmse_m", "m", "relative position error over 1 m of true path"},
    scores.rpe_1m_rmse_m);
  v(ResultKey{prefix + "rpe_1m_angle_rmse_deg", "deg",
              "relative heading error over 1 m of true path"},
    scores.rpe_1m_angle_rmse_deg);
}

void visit_relations(const std::string& prefix, auto& scores, auto&& v) {
  v(ResultKey{prefix + "relations_used", "1", "relations whose two times the trajectory covers"},
    scores.relations_used);
  v(ResultKey{prefix + "relations_skipped", "1", "relations left out"}, scores.relations_skipped);
  v(ResultKey{prefix + "relations_translation_mean_m", "m",
              "mean translation error of the relations"},
    scores.relations_translation_mean_m);
  v(ResultKey{prefix + "relations_translation_std_m", "m", "standard deviation of the same"},
    scores.relations_translation_std_m);
  v(ResultKey{prefix + "relations_rotation_mean_deg", "deg",
              "mean absolute rotation error of the relations"},
    scores.relations_rotation_mean_deg);
  v(ResultKey{prefix + "relations_rotation_std_deg", "deg", "standard deviation of the same"},
    scores.relations_rotation_std_deg);
}

void visit_map(const std::string& prefix, auto& scores, auto&& v) {
  v(ResultKey{prefix + "key_distances", "m, deg",
              "lengths a, b, c and angle alpha of the corridor, measured on the map"},
    scores.key_distances);
  v(ResultKey{prefix + "map_chamfer_m", "m",
              "mean distance between the map's walls and the true walls, both ways"},
    scores.map_chamfer_m);
  v(ResultKey{prefix + "map_hausdorff95_m", "m",
              "95 % quantile of the same distances, the larger of both ways"},
    scores.map_hausdorff95_m);
}

void visit_what(auto& r, auto&& v) {
  v(ResultKey{"case_id", "", "readable name and hash of the case", false}, r.case_id);
  v(ResultKey{"suite", "", "suite the case belongs to", false}, r.suite);
  v(ResultKey{"system", "", "SLAM system", false}, r.system);
  v(ResultKey{"profile", "", "named parameter set of the system", false}, r.profile);
  v(ResultKey{"backend", "", "graph back-end, null for systems without one", false}, r.backend);
  v(ResultKey{"dataset", "", "data set, scenario or log file", false}, r.dataset);
  v(ResultKey{"data_kind", "", "simulated, recorded or graph", false}, r.data_kind);
  v(ResultKey{"data_source", "", "what was loaded: name, or absolute path of a file", false},
    r.data_source);
  v(ResultKey{"data_digest", "", "hash of the log, its truth and calibration, or of the scenario",
              false},
    r.data_digest);
  v(ResultKey{"true_poses", "", "truth, or reference: poses another program found; null for none",
              false},
    r.true_poses);
  v(ResultKey{"data_seed", "", "seed of the simulated log, null for recorded data", false},
    r.data_seed);
  v(ResultKey{"system_seed", "", "seed of the system's random generator", false}, r.system_seed);
  v(ResultKey{"threads", "1", "threads the system may use", false}, r.threads);
  v(ResultKey{"jobs", "1", "cases that ran at a time, null if not known", false}, r.jobs);
  v(ResultKey{"parameters_hash", "", "hash of all parameter values", false}, r.parameters_hash);
  v(ResultKey{"parameters", "", "every parameter's value", false}, r.parameters);
  v(ResultKey{"overrides", "", "parameters set by hand, {} for none, null if not known", false},
    r.overrides);
  v(ResultKey{"git_revision", "", "revision of the program, +dirty with local changes", false},
    r.git_revision);
  v(ResultKey{"build_id", "", "hash of the program's file: tells builds of one revision apart",
              false},
    r.build_id);
  v(ResultKey{"machine_id", "", "hash of the machine's fingerprint", false}, r.machine_id);
}

void visit_outcome(auto& r, auto&& v) {
  v(ResultKey{"status", "", "how the case ended", false}, r.status);
  v(ResultKey{"status_message", "", "why, where it is not ok", false}, r.status_message);
  v(ResultKey{"notes", "", "what a reader of the scores should know", false}, r.notes);
  v(ResultKey{"poses_expected", "1", "poses that should have been given"}, r.poses_expected);
  v(ResultKey{"poses_matched", "1", "poses that were given and matched with the truth"},
    r.poses_matched);
  v(ResultKey{"association", "", "how estimated and true stamps were matched", false},
    r.association);
  v(ResultKey{"alignment", "", "how the trajectories were aligned", false}, r.alignment);
}

void visit_estimator(auto& r, auto&& v) {
  v(ResultKey{"bound_position_rmse_m", "m",
              "Cramer-Rao bound of position_rmse_m: what the log allows, of no system", false},
    r.bound_position_rmse_m);
  v(ResultKey{"bound_angle_rmse_deg", "deg", "the same of angle_rmse_deg", false},
    r.bound_angle_rmse_deg);
  v(ResultKey{"nees_mean", "1",
              "normalised estimation error squared, mean over poses along the run; its degrees of "
              "freedom if consistent"},
    r.nees_mean);
  v(ResultKey{"nees_last", "1", "the same of the last key scan's pose alone"}, r.nees_last);
  v(ResultKey{"nees_dof", "1", "degrees of freedom of one NEES sample"}, r.nees_dof);
  v(ResultKey{"chi2", "1", "weighted squared error of the graph at the end"}, r.chi2);
  v(ResultKey{"factors", "1", "factors of the graph at the end"}, r.factors);
  v(ResultKey{"variables", "1", "variables of the graph at the end"}, r.variables);
  v(ResultKey{"relinearised", "1", "variables relinearised, summed over the run"}, r.relinearised);
  v(ResultKey{"iterations", "1", "iterations of the solver, summed over the run"}, r.iterations);
  v(ResultKey{"eliminated", "1", "variables eliminated anew, summed over the run"}, r.eliminated);
  v(ResultKey{"factor_nonzeros", "1", "nonzeros of the Cholesky factor at the end"},
    r.factor_nonzeros);
  v(ResultKey{"chi2_initial", "1", "chi2 of a graph's initial values"}, r.chi2_initial);
  v(ResultKey{"chi2_best", "1", "smallest chi2 that is known for the graph", false}, r.chi2_best);
  v(ResultKey{"chi2_best_source", "", "catalogue, or own: found beside the case", false},
    r.chi2_best_source);
  v(ResultKey{"chi2_gap_ratio", "1", "chi2 / chi2_best - 1"}, r.chi2_gap_ratio);
  v(ResultKey{"run_gap_p50_ratio", "1",
              "median over a run of chi2 / optimum of the graph so far - 1"},
    r.run_gap_p50_ratio);
  v(ResultKey{"run_gap_max_ratio", "1", "largest of the same"}, r.run_gap_max_ratio);
  v(ResultKey{"run_newest_gap_max_m", "m",
              "largest distance of the newest pose to where the optimum so far has it"},
    r.run_newest_gap_max_m);
  v(ResultKey{"false_closures", "1", "false loop closures that were planted"}, r.false_closures);
  v(ResultKey{"rejected_closures", "1", "loop closures that the robust method rejected"},
    r.rejected_closures);
  v(ResultKey{"rejection_precision", "1", "share of the rejected closures that were false"},
    r.rejection_precision);
  v(ResultKey{"rejection_recall", "1", "share of the false closures that were rejected"},
    r.rejection_recall);
  v(ResultKey{"slip_precision", "1", "share of slip alarms that were true"}, r.slip_precision);
  v(ResultKey{"slip_recall", "1", "share of slip time that was noticed"}, r.slip_recall);
  v(ResultKey{"slip_latency_s", "s", "time from a slip's begin to its alarm"}, r.slip_latency_s);
  v(ResultKey{"degeneracy_precision", "1", "share of degeneracy alarms that were true"},
    r.degeneracy_precision);
  v(ResultKey{"degeneracy_recall", "1", "share of degenerate scans that were noticed"},
    r.degeneracy_recall);
  v(ResultKey{"counters", "1", "totals as the system named them"}, r.counters);
}

void visit_cost(auto& r, auto&& v) {
  v(ResultKey{"stages", "s, us", "exclusive times of the stages"}, r.stages);
  v(ResultKey{"step_mean_us", "us", "mean time of an update of a graph"}, r.step_mean_us);
  v(ResultKey{"step_p50_us", "us", "median time of a scan's step, or of a graph's update"},
    r.step_p50_us);
  v(ResultKey{"step_p95_us", "us", "95 % quantile of the same"}, r.step_p95_us);
  v(ResultKey{"step_p99_us", "us", "99 % quantile of the same"}, r.step_p99_us);
  v(ResultKey{"step_max_us", "us", "longest step or update"}, r.step_max_us);
  v(ResultKey{"init_s", "s", "of wall_s: until a graph has initial values"}, r.init_s);
  v(ResultKey{"wall_s", "s", "time in step() and finish(), or of solving a graph"}, r.wall_s);
  v(ResultKey{"cpu_s", "s", "processor time of the same, all threads"}, r.cpu_s);
  v(ResultKey{"peak_rss_mib", "MiB", "largest resident memory while the system ran"},
    r.peak_rss_mib);
  v(ResultKey{"peak_growth_mib", "MiB", "of that, beyond what the process had before"},
    r.peak_growth_mib);
  v(ResultKey{"realtime_factor", "1", "duration of the log divided by wall_s"}, r.realtime_factor);
}

}  // namespace detail

// Calls v(ResultKey, field) for every key. `result` is a RunResult or const RunResult.
void visit_keys(auto& result, auto&& v) {
  detail::visit_what(result, v);
  detail::visit_outcome(result, v);
  detail::visit_trajectory("", result.final_scores, v);
  detail::visit_trajectory("online_", result.online_scores, v);
  detail::visit_relations("", result.final_relations, v);
  detail::visit_relations("online_", result.online_relations, v);
  detail::visit_map("", result.own_map, v);
  detail::visit_map("rendered_", result.rendered_map, v);
  detail::visit_estimator(result, v);
  detail::visit_cost(result, v);
}

// Every key, for documentation.
std::vector<ResultKey> result_keys();

}  // namespace corridor::results
