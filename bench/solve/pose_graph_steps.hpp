// A pose graph of a file as it would come to a robot, pose by pose.
#pragma once

#include "bench/solve/reject_closures.hpp"
#include "bench/solve/steps.hpp"
#include "slam/core/result.hpp"

namespace corridor::solve {

// Poses in the order of backend::spanning_order(), each with all edges to earlier ones; every so
// many poses, and at the last one, the back-end is to solve. `problem` must outlive the steps. The
// Error names a pose that no edges join to a held one.
Result<Steps> pose_graph_steps(const Problem& problem, int poses_per_update);

}  // namespace corridor::solve
