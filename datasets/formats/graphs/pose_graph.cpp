#include "datasets/formats/graphs/pose_graph.hpp"

#include <algorithm>
#include <set>
#include <unordered_map>
#include <utility>

#include "slam/core/disjoint_sets.hpp"
#include "slam/graph/factors/pose_factors.hpp"

namespace corridor::formats {
std::size_t num_parts(const PoseGraph& graph) {
  std::unordered_map<std::uint32_t, std::size_t> index_of;
  for (const PoseGraph::Vertex& vertex : graph.vertices) {
    index_of.emplace(vertex.id, index_of.size());
  }
  DisjointSets parts(index_of.size());
  for (const PoseGraph::Edge& edge : graph.edges) {
    parts.join(index_of.at(edge.i), index_of.at(edge.j));
  }
  return parts.num_sets();
}

std::size_t num_repeated_pairs(const PoseGraph& graph) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (const PoseGraph::Edge& edge : graph.edges) pairs.insert(std::minmax(edge.i, edge.j));
  return graph.edges.size() - pairs.size();
}

GraphProblem factor_graph_of(const PoseGraph& graph) {
  GraphProblem problem;
  for (const PoseGraph::Vertex& vertex : graph.vertices) {
    problem.values.set_pose(vertex.id, vertex.T_map_base);
  }
  for (const PoseGraph::Edge& edge : graph.edges) {
    problem.factors.add(graph::RelativePose(
        graph::pose_key(edge.i), graph::pose_key(edge.j), edge.T_i_j,
        graph::square_root_information(edge.information), graph::RelativePoseError::kComponents));
  }
  return problem;
}

}  // namespace corridor::formats
