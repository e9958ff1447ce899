// What a graph system is: how a back-end is given a pose graph, beside the SLAM systems that are
// given a log. Its name and parameters stand in the table of systems (systems.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/runner/back_ends.hpp"
#include "bench/solve/false_closures.hpp"
#include "bench/solve/solve_graph.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/core/params.hpp"

namespace corridor::runner {

// All poses and edges at once.
struct GraphBatchParams {
  std::string start = "file";  // "file", "odometry", "chordal" or "optimum"
  // Noise on the initial values, drawn with the system's seed.
  double start_position_sigma_m = 0;
  double start_heading_sigma_rad = 0;
  int max_iterations = solve::kMaxBatchIterations;
  double min_relative_decrease = solve::kMinBatchRelativeDecrease;
  // False closures, drawn with the system's seed, and what is done against them.
  double false_closures = 0;
  std::string false_pairs = "random";
  std::string robust = "none";
  double kernel_width = 1;
  double inlier_probability = solve::SolveOptions().inlier_probability;

  std::vector<std::string> relations() const;

  template <class V>
  static void visit(GraphBatchParams& p, V&& v) {
    v(ParamInfo{"start", "",
                "initial values: those of the file, odometry, chordal relaxation, or the optimum "
                "that is known beforehand"},
      p.start);
    v(ParamInfo{"start_position_sigma_m", "m", "white noise on the x and y of initial values", 0},
      p.start_position_sigma_m);
    v(ParamInfo{"start_heading_sigma_rad", "rad", "white noise on the headings of initial values",
                0},
      p.start_heading_sigma_rad);
    v(ParamInfo{"max_iterations", "1", "limit of gauss-newton and levenberg", 1, 1000},
      p.max_iterations);
    v(ParamInfo{"min_relative_decrease", "1",
                "gauss-newton and levenberg stop when chi2 falls by a smaller share", 0, 1},
      p.min_relative_decrease);
    v(ParamInfo{"false_closures", "1", "share of the closures that are planted and false", 0, 0.95},
      p.false_closures);
    v(ParamInfo{"false_pairs", "", "which poses they join: random, local or grouped"},
      p.false_pairs);
    v(ParamInfo{"robust", "", "kernel, or what rejects false closures, as solve --robust"},
      p.robust);
    v(ParamInfo{"kernel_width", "1", "in standard deviations of the whitened residual", 1e-3, 1e3},
      p.kernel_width);
    v(ParamInfo{"inlier_probability", "1",
                "of a true closure to be below the bound beyond which it is rejected", 0.5,
                0.999999},
      p.inlier_probability);
  }
};

// Pose by pose, each with its edges to earlier ones; the newest is read after every update.
struct GraphIncrementalParams {
  int poses_per_update = 1;
  // The run is done again for them, so that they take no time of it; 0: not at all.
  int num_checkpoints = 50;
  bool use_calls = false;

  std::vector<std::string> relations() const;

  template <class V>
  static void visit(GraphIncrementalParams& p, V&& v) {
    v(ParamInfo{"poses_per_update", "1",
                "the solver is called at every K-th pose; the others wait at their edges", 1,
                1'000'000},
      p.poses_per_update);
    v(ParamInfo{"num_checkpoints", "1",
                "updates after which the gap to the batch optimum is measured, in a replay", 0,
                100'000},
      p.num_checkpoints);
    v(ParamInfo{"use_calls", "",
                "steps are the calls that the system made whose graph it is, not its poses"},
      p.use_calls);
  }
};

struct GraphTask {
  solve::SolveOptions options;
  // Limits for back-ends of our own that solve at once.
  backend::LeastSquaresParams settings;
  bool starts_at_optimum = false;
  double start_position_sigma_m = 0;
  double start_heading_sigma_rad = 0;
  int num_checkpoints = 0;
  bool use_calls = false;
  double false_closures = 0;
  solve::FalsePairs false_pairs = solve::FalsePairs::kRandom;

  [[nodiscard]] bool has_start_noise() const {
    return start_position_sigma_m > 0 || start_heading_sigma_rad > 0;
  }
};

GraphTask task_of(const GraphBatchParams& params);
GraphTask task_of(const GraphIncrementalParams& params);

// What the task asks for that such a graph does not have: a pose graph no calls, the graph of a
// system neither poses that come one by one nor closures and starts like those of pose graphs.
std::optional<std::string> why_unfit(const GraphTask& task, bool is_of_system);
// A back-end that forgets poses has nothing to compare where all are asked for at once.
std::optional<std::string> why_unfit(const GraphTask& task, const BackEndInfo& back_end);

}  // namespace corridor::runner
