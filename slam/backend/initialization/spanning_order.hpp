// The order in which the poses of a graph can be placed one behind the other along its edges: a
// spanning tree that grows from the held poses, always by the lowest pose that has an edge to it.
// On a drive whose poses are numbered as they came this is the drive.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slam/core/result.hpp"
#include "slam/graph/factor_graph.hpp"
#include "slam/graph/values.hpp"

namespace corridor::backend {

struct Placement {
  std::uint32_t pose = 0;
  // To an earlier one: of the poses below this one the nearest, else the nearest above; the first
  // of several edges between the two. Null for a held pose. Valid until the graph changes.
  const graph::RelativePose* edge = nullptr;

  // Requires an edge.
  [[nodiscard]] std::uint32_t parent() const;
  [[nodiscard]] Pose2 T_parent_pose() const;
};

// Places every pose of `values`, the held ones first; without any, the lowest pose is held. The
// Error names a pose that no edges join to a held one. Requires that held poses, and those of
// every edge, are in `values`.
Result<std::vector<Placement>> spanning_order(const graph::FactorGraph& graph,
                                              const graph::Values& values,
                                              std::span<const std::uint32_t> held);

// Every relative pose of the graph, in the order of the factors' numbers.
std::vector<const graph::RelativePose*> relative_poses(const graph::FactorGraph& graph);

}  // namespace corridor::backend
