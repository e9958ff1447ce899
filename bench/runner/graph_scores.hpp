// Scores of a case that solves a pose graph: chi2 against the best that is known, poses against the
// truth, times, the gap along the run, and how it ended.
#pragma once

#include <vector>

#include "bench/results/run_result.hpp"
#include "bench/runner/graph_case_files.hpp"
#include "bench/solve/gap_trace.hpp"
#include "bench/solve/solve_graph.hpp"

namespace corridor::runner {

// Requires chi2_best of `result`.
void score_solution(const formats::PoseGraph& graph, const solve::SolveRun& run,
                    results::RunResult& result);

// How many false closures were planted, and how many of them the robust method found.
void score_rejection(const formats::PoseGraph& graph, const solve::SolveOptions& options,
                     const solve::SolveRun& run, results::RunResult& result);

// Against true poses, first poses aligned; without any, how many poses there are. After
// score_solution().
void score_poses(const Poses& truth, const Poses& final, const Poses& online,
                 results::RunResult& result);

void score_times(const solve::SolveRun& run, results::RunResult& result);

void score_trace(const std::vector<solve::Checkpoint>& checkpoints, results::RunResult& result);

// `failed`: a pose is undetermined. `diverged`: numbers that are not finite, the limit of
// iterations, or a chi2 that is that of another minimum. Requires all that is above.
void settle_status(solve::Mode mode, const solve::SolveRun& run, results::RunResult& result);

}  // namespace corridor::runner
