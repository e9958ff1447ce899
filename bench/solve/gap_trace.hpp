// How far an incremental solution is from the batch optimum along its way: the whole run is done
// again with the same back-end, and at a few checkpoints the graph so far is solved to its optimum:
// all of it, whatever of it the back-end has forgotten. Checkpoints lie right after updates.
// A final value alone would reward those who do their work at the end.
#pragma once

#include <cstddef>
#include <vector>

#include "bench/solve/solve_graph.hpp"

namespace corridor::solve {

struct Checkpoint {
  std::size_t update_index = 0;
  double chi2 = 0;          // of what there is so far, by the graph's Measure
  double chi2_optimum = 0;  // the smallest of optimum_near()
  // Of the newest pose, between the solution and the optimum.
  double newest_gap_m = 0;
  double newest_gap_rad = 0;
};

// `back_end` is empty before; `options` are those of the run that is replayed, which had
// `num_updates`. Checkpoints are evenly spaced over the updates, the last update is always one.
// Fewer where the solution failed on the way. Requires kIncremental and num_checkpoints > 0.
Result<std::vector<Checkpoint>> trace_gap(const formats::PoseGraph& graph,
                                          backend::BackEnd& back_end, const SolveOptions& options,
                                          std::size_t num_updates, std::size_t num_checkpoints);
Result<std::vector<Checkpoint>> trace_gap(const Recording& recording, backend::BackEnd& back_end,
                                          const SolveOptions& options, std::size_t num_updates,
                                          std::size_t num_checkpoints);

}  // namespace corridor::solve
