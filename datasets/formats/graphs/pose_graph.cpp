#include "datasets/formats/graphs/pose_graph.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <unordered_map>
#include <utility>

#include "slam/graph/factors/pose_factors.hpp"

namespace corridor::formats {
namespace {

// Union-find with path halving.
std::size_t root_of(std::vector<std::size_t>& parents, std::size_t index) {
  while (parents[index] != index) index = parents[index] = parents[parents[index]];
  return index;
}

}  // namespace

std::size_t num_parts(const PoseGraph& graph) {
  std::unordered_map<std::uint32_t, std::size_t> index_of;
  for (const PoseGraph::Vertex& vertex : graph.vertices) {
    index_of.emplace(vertex.id, index_of.size());
  }
  std::vector<std::size_t> parents(index_of.size());
  std::iota(parents.begin(), parents.end(), std::size_t{0});
  std::size_t num_left = parents.size();
  for (const PoseGraph::Edge& edge : graph.edges) {
    const std::size_t a = root_of(parents, index_of.at(edge.i));
    const std::size_t b = root_of(parents, index_of.at(edge.j));
    if (a == b) continue;
    parents[a] = b;
    --num_left;
  }
  return num_left;
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
