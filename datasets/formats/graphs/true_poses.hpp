// The true poses of a pose graph, as the Manhattan world's come: a line "x y theta" [m, rad] per
// pose, in ascending order of the graph's pose numbers.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/formats/graphs/pose_graph.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

// Where they lie: GRAPH.truth-nodes.dat beside GRAPH.g2o.
std::filesystem::path true_poses_beside(const std::filesystem::path& graph_file);

// One per vertex of `graph`, in ascending order. An Error with file:line for a line that is not
// three finite numbers, and for more or fewer lines than the graph has poses.
Result<std::vector<PoseGraph::Vertex>> read_true_poses(const std::filesystem::path& path,
                                                       const PoseGraph& graph);

// The same on text; `name` stands for the file in messages.
Result<std::vector<PoseGraph::Vertex>> parse_true_poses(std::string_view text,
                                                        const PoseGraph& graph,
                                                        const std::string& name);

}  // namespace corridor::formats
