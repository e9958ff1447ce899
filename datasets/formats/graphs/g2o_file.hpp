// What a graph-based system solved, as g2o text: VERTEX_SE2, EDGE_SE2, FIX.
// Only what g2o's SE2 vocabulary holds: poses and relative poses. The rest is counted in a comment.
// pose_graph_file.hpp reads it back.
#pragma once

#include <filesystem>

#include "datasets/formats/graphs/pose_graph.hpp"
#include "slam/core/result.hpp"
#include "slam/graph/factor_graph.hpp"
#include "slam/graph/values.hpp"

namespace corridor::formats {

// The poses and relative poses of a factor graph. A pose with a prior is fixed; without any, the
// first pose is. The notes say so of each prior, and count what is left out.
PoseGraph pose_graph_of(const graph::FactorGraph& graph, const graph::Values& values);

// Vertices in ascending order, then edges in the order of their factor numbers; information upper
// triangular in the order (x x, x y, x theta, y y, y theta, theta theta).
// The notes of pose_graph_of() are comments.
Result<void> write_g2o(const graph::FactorGraph& graph, const graph::Values& values,
                       const std::filesystem::path& path);

}  // namespace corridor::formats
