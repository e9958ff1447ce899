// The graph that a SLAM system makes, as its back-end was told it: every call that changes the
// graph, in order. A recording can be solved like a pose graph of a file, at once or call by call,
// by any back-end (solve_graph.hpp).
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/solve/steps.hpp"
#include "slam/backend/back_end.hpp"
#include "slam/graph/factor_graph.hpp"
#include "slam/graph/values.hpp"

namespace corridor::solve {

struct Recording {
  std::vector<Step> steps;
  graph::Values final_estimate;  // of the system's own back-end, when all was done

  // Factors that nothing removed, with their kernels, and every variable as it was when it came.
  // What was marginalised is in both: the whole problem.
  [[nodiscard]] graph::FactorGraph factors() const;
  [[nodiscard]] graph::Values initial_values() const;
};

Steps steps_of(const Recording& recording);

// Takes away what came after the last call that solves, steps and final values: nobody ever asked
// for its solution, and it would be the same gap to the optimum for every back-end. The number of
// factors that went; all, where nothing solves.
std::size_t drop_unsolved_end(Recording& recording);

// Wraps the back-end of a system: forwards everything, and keeps each call in `recording`, which
// must outlive it. A call that solves ends an update; calls that only add, set or marginalise are
// part of the next one.
std::unique_ptr<backend::BackEnd> make_recording(std::unique_ptr<backend::BackEnd> back_end,
                                                 Recording& recording);

// How many factors of each kind there are: {"imu_motion", 311}.
std::map<std::string, std::size_t> kinds_of(const graph::FactorGraph& factors);

}  // namespace corridor::solve
