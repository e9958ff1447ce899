// The poses of a graph that are held, and the priors that hold them.
#pragma once

#include <cstdint>
#include <vector>

#include "datasets/formats/graphs/pose_graph.hpp"
#include "slam/graph/factors/pose_factors.hpp"

namespace corridor::solve {

// The fixed poses; without any, the lowest one. Requires a vertex.
std::vector<std::uint32_t> held_poses(const formats::PoseGraph& graph);

// Priors at the values that the held poses have, in the order of `held`.
std::vector<graph::PosePrior> priors_on(const std::vector<std::uint32_t>& held,
                                        const formats::PoseGraph& graph,
                                        const graph::Values& values);

}  // namespace corridor::solve
