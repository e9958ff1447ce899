// One case, run and scored: plain data with a unit in every field's name.
// The JSON keys and the columns of the store are these names; they are a contract: every key is
// always written, null where it does not apply; new ones are added, none is renamed.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace corridor::results {

// How a case ended. Everything but kOk is a row in every table, never a gap.
enum class CaseStatus {
  kOk,        // ran to the end and every expected pose was matched
  kPartial,   // ran to the end, but poses are missing
  kDiverged,  // ran to the end, but is lost: not finite, by its own report, or by its error
              // (run_case.cpp)
  kFailed,    // the system returned an error, or the process crashed
  kTimeout,
  kOutOfMemory,
  kBadInput,
};

// The JSON text: "ok partial diverged failed timeout out_of_memory bad_input".
std::string to_text(CaseStatus status);
std::optional<CaseStatus> case_status_from_text(const std::string& text);

// A smallest chi2 of at most this says that every measurement is met, as on a drive before its
// first loop closure: a ratio to it says nothing.
inline constexpr double kExactFit_chi2 = 1e-9;

struct TrajectoryScores {
  // First poses aligned (the paper's two).
  std::optional<double> position_rmse_m, angle_rmse_deg;
  // After the SE(2) alignment of [Umeyama1991] without scale.
  std::optional<double> ate_se2_rmse_m, ate_se2_angle_rmse_deg;
  // Over 1 m of true path.
  std::optional<double> rpe_1m_rmse_m, rpe_1m_angle_rmse_deg;
};

struct RelationScores {
  std::optional<std::int64_t> relations_used, relations_skipped;
  std::optional<double> relations_translation_mean_m, relations_translation_std_m;
  std::optional<double> relations_rotation_mean_deg, relations_rotation_std_deg;
};

struct KeyDistance {
  std::optional<double> true_m, measured_m, error_m, sigma_m;
  std::string status;  // "ok" or why it is not measurable
};

struct KeyAngle {
  std::optional<double> true_deg, measured_deg, error_deg, sigma_deg;
  std::string status;
};

struct KeyDistances {
  KeyDistance a, b, c;
  KeyAngle alpha;
};

struct MapScores {
  std::optional<KeyDistances> key_distances;
  std::optional<double> map_chamfer_m, map_hausdorff95_m;
};

struct StageTimes {
  std::string name;
  std::int64_t count = 0;  // steps in which the stage was entered
  double total_s = 0;
  double p50_us = 0, p95_us = 0, p99_us = 0, max_us = 0;
};

struct RunResult {
  // what
  std::string case_id;
  std::string suite;
  std::string system, profile;
  std::optional<std::string> backend;
  std::string dataset;  // catalogue name, scenario name or file
  std::optional<std::string>
      data_kind;  // "simulated", "recorded" or "graph"; null: an older revision
  std::optional<std::string> data_source;  // what was loaded: name, or absolute path of the file
  std::optional<std::string> data_digest;  // of the log and its truth, or the scenario's values
  // What poses are compared with: "truth", or "reference", poses that another program found; null:
  // with none, or an older revision.
  std::optional<std::string> true_poses;
  std::optional<std::uint64_t> data_seed;  // null for recorded data
  std::uint64_t system_seed = 0;
  int threads = 1;
  std::optional<int> jobs;  // cases that ran at a time; null if nobody said
  std::string parameters_hash;
  std::map<std::string, std::string> parameters;
  // What was set by hand on top of the profile; null: an older revision, which did not say.
  std::optional<std::map<std::string, std::string>> overrides;
  std::string git_revision;
  std::optional<std::string> build_id;  // of the program's file; null: an older revision
  std::string machine_id;

  // outcome
  CaseStatus status = CaseStatus::kFailed;
  std::string status_message;
  std::vector<std::string> notes;  // what a reader of the scores should know
  std::optional<std::int64_t> poses_expected, poses_matched;
  std::optional<std::string> association, alignment;

  // accuracy
  TrajectoryScores final_scores;   // keys without prefix
  TrajectoryScores online_scores;  // keys with prefix online_
  RelationScores final_relations;
  RelationScores online_relations;  // keys with prefix online_
  MapScores own_map;                // the system's own map
  MapScores rendered_map;           // one common mapper's map of its trajectory; prefix rendered_

  // estimator
  std::optional<double> bound_position_rmse_m, bound_angle_rmse_deg;  // of simulated logs
  std::optional<double> nees_mean, nees_last;
  std::optional<std::int64_t> nees_dof;
  std::optional<double> chi2;
  std::optional<std::int64_t> factors, variables, relinearised;
  // Of cases that solve a graph.
  std::optional<std::int64_t> iterations, eliminated, factor_nonzeros;
  std::optional<double> chi2_initial;
  std::optional<double> chi2_best;              // the smallest that is known
  std::optional<std::string> chi2_best_source;  // "catalogue", or "own": found beside the case
  std::optional<double> chi2_gap_ratio;         // chi2 / chi2_best - 1
  // To the optimum of the graph so far, over the checkpoints of an incremental run.
  std::optional<double> run_gap_p50_ratio, run_gap_max_ratio, run_newest_gap_max_m;
  // Of graphs into which false closures were planted, or where something looked for them.
  std::optional<std::int64_t> false_closures, rejected_closures;
  std::optional<double> rejection_precision, rejection_recall;
  std::optional<double> slip_precision, slip_recall, slip_latency_s;
  std::optional<double> degeneracy_precision, degeneracy_recall;
  std::map<std::string, double> counters;  // SlamEstimate::counters as given

  // cost: step() and finish() only
  std::vector<StageTimes> stages;
  std::optional<double> step_mean_us, step_p50_us, step_p95_us, step_p99_us, step_max_us;
  std::optional<double> init_s;  // of wall_s: until a graph has initial values
  std::optional<double> wall_s, cpu_s, peak_rss_mib, realtime_factor;
  std::optional<double> peak_growth_mib;  // of peak_rss_mib; null: an older revision
};

}  // namespace corridor::results
