// Planar pose graphs in and out: one door for every graph format of the suite.
//   g2o   VERTEX_SE2 id x y theta   EDGE_SE2 i j dx dy dtheta Ixx Ixy Ixt Iyy Iyt Itt   FIX id ..
//   TORO  VERTEX2 id x y theta      EDGE2 i j dx dy dtheta Ixx Ixy Iyy Itt Ixt Iyt
// [m], [rad]; both hold one triangle of the information, so that it is symmetric by its form.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/formats/graphs/pose_graph.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

enum class GraphFormat { kG2o, kToro };

// "g2o", "TORO".
std::string_view to_text(GraphFormat format);

// .g2o ; .graph .toro (TORO).
std::optional<GraphFormat> graph_format_from_suffix(const std::filesystem::path& path);

// An Error with file:line for: an unknown tag or one of the other format, field count, number
// syntax, a value that is not finite, an id beyond kMaxPoseId, a vertex or a fixed pose given
// twice, an edge from a pose to itself or to a pose that has no vertex, information with a negative
// eigenvalue, no vertex at all. Counted in PoseGraph::notes: pairs of poses joined twice, singular
// information, angles wrapped to (-pi, pi], parts that no edge joins, a last line without its end.
Result<PoseGraph> read_pose_graph(const std::filesystem::path& path);

// The same on text; `name` stands for the file in messages.
Result<PoseGraph> parse_pose_graph(std::string_view text, GraphFormat format,
                                   const std::string& name);

// Vertices and edges in the graph's order, with as many digits as give back the same numbers.
std::string pose_graph_text(const PoseGraph& graph, GraphFormat format);

// By the suffix of `path`.
Result<void> write_pose_graph(const PoseGraph& graph, const std::filesystem::path& path);

// What `target` cannot hold of this very graph, one line each; empty = nothing is lost.
std::vector<std::string> losses_of_conversion(const PoseGraph& graph, GraphFormat target);

}  // namespace corridor::formats
