// Pose graphs, read as g2o and as TORO. A graph that was read is the same after being written and
// read again, and can be handed to a solver.
#include "datasets/formats/graphs/pose_graph.hpp"

#include <algorithm>

#include "datasets/formats/graphs/pose_graph_file.hpp"
#include "slam/core/expect.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {
namespace {

using formats::GraphFormat;
using formats::PoseGraph;

// Values keep a slot for every index: those of a large one take longer than a thousand inputs.
constexpr std::uint32_t kMaxSolvedId = 1000;

bool is_same(const PoseGraph& a, const PoseGraph& b) {
  const auto same_vertex = [](const PoseGraph::Vertex& u, const PoseGraph::Vertex& v) {
    return u.id == v.id && u.T_map_base == v.T_map_base;
  };
  const auto same_edge = [](const PoseGraph::Edge& u, const PoseGraph::Edge& v) {
    return u.i == v.i && u.j == v.j && u.T_i_j == v.T_i_j && u.information == v.information;
  };
  return std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                    same_vertex) &&
         std::equal(a.edges.begin(), a.edges.end(), b.edges.begin(), b.edges.end(), same_edge);
}

bool read_as(GraphFormat format, std::string_view bytes) {
  const auto graph = formats::parse_pose_graph(bytes, format, "a.graph");
  if (!graph) return false;
  const auto again =
      formats::parse_pose_graph(formats::pose_graph_text(*graph, format), format, "a.graph");
  CORRIDOR_EXPECT(again.has_value() && is_same(*graph, *again));
  const bool is_small = std::all_of(graph->vertices.begin(), graph->vertices.end(),
                                    [](const auto& vertex) { return vertex.id <= kMaxSolvedId; });
  if (is_small) formats::factor_graph_of(*graph);
  return true;
}

}  // namespace

bool pose_graph(std::string_view bytes) {
  const bool is_g2o = read_as(GraphFormat::kG2o, bytes);
  return read_as(GraphFormat::kToro, bytes) || is_g2o;
}

}  // namespace corridor::fuzz
