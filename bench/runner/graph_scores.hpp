// Scores of a case that solves a pose graph: chi2 against the best that is known, poses against the
// truth, times, the gap along the run, and how it ended.
#pragma once

#include <cstdint>
#include <vector>

#include "bench/results/run_result.hpp"
#include "bench/runner/graph_case_files.hpp"
#include "bench/solve/gap_trace.hpp"
#include "bench/solve/recording.hpp"
#include "bench/solve/solve_graph.hpp"

namespace corridor::runner {

struct GraphSize {
  std::int64_t num_factors = 0;
  std::int64_t num_variables = 0;
  std::int64_t num_poses = 0;
  // Scalars measured beyond those that are solved for; at least one.
  std::int64_t num_degrees_of_freedom = 1;
};
// Without priors that hold poses: they measure nothing.
GraphSize size_of(const formats::PoseGraph& graph);
// Of what it ends with.
GraphSize size_of(const solve::Recording& recording);

// Requires chi2_best of `result`.
void score_solution(const GraphSize& size, const solve::SolveRun& run, results::RunResult& result);

// How many false closures were planted, and how many of them the robust method found.
void score_rejection(const formats::PoseGraph& graph, const solve::SolveOptions& options,
                     const solve::SolveRun& run, results::RunResult& result);

// Against true poses, first poses aligned; without any, how many poses there are.
void score_poses(const GraphSize& size, const Poses& truth, const Poses& final, const Poses& online,
                 results::RunResult& result);

void score_times(solve::Mode mode, const solve::SolveRun& run, results::RunResult& result);

void score_trace(const std::vector<solve::Checkpoint>& checkpoints, results::RunResult& result);

// `failed`: a pose is undetermined. `diverged`: numbers that are not finite, the limit of
// iterations, or a chi2 that is that of another minimum. Requires all that is above.
void settle_status(const GraphSize& size, solve::Mode mode, const solve::SolveRun& run,
                   results::RunResult& result);

}  // namespace corridor::runner
