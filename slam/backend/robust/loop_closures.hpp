// Which edges of a pose graph are loop closures, and so may be false.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slam/core/result.hpp"
#include "slam/graph/factor_graph.hpp"
#include "slam/graph/values.hpp"

namespace corridor::backend {

// The relative poses that are not in the tree of spanning_order(), ascending: on a drive whose
// poses are numbered as they came the tree is odometry, and without any closure every pose is still
// held. A second edge between consecutive poses is a closure: it can be rejected without loss.
// The Error names a pose that no edges join to a held one.
Result<std::vector<graph::FactorId>> loop_closures(const graph::FactorGraph& graph,
                                                   const graph::Values& values,
                                                   std::span<const std::uint32_t> held);

}  // namespace corridor::backend
