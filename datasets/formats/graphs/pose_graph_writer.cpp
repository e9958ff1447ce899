#include <fmt/format.h>

#include <array>
#include <utility>

#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/graphs/pose_graph_file.hpp"
#include "datasets/formats/graphs/pose_graph_vocabulary.hpp"

namespace corridor::formats {
namespace {

constexpr std::array<std::pair<std::string_view, GraphFormat>, 3> kSuffixes = {
    {{".g2o", GraphFormat::kG2o}, {".graph", GraphFormat::kToro}, {".toro", GraphFormat::kToro}}};

std::string numbers_of(const Pose2& pose) {
  return fmt::format("{} {} {}", pose.x_m(), pose.y_m(), pose.theta_rad());
}

}  // namespace

std::string_view to_text(GraphFormat format) {
  return format == GraphFormat::kG2o ? "g2o" : "TORO";
}

std::optional<GraphFormat> graph_format_from_suffix(const std::filesystem::path& path) {
  for (const auto& [suffix, format] : kSuffixes) {
    if (path.extension() == suffix) return format;
  }
  return std::nullopt;
}

std::string pose_graph_text(const PoseGraph& graph, GraphFormat format) {
  const GraphVocabulary& words = vocabulary_of(format);
  std::string text;
  for (const PoseGraph::Vertex& vertex : graph.vertices) {
    text += fmt::format("{} {} {}\n", words.vertex_tag, vertex.id, numbers_of(vertex.T_map_base));
  }
  if (!words.fix_tag.empty()) {
    for (const std::uint32_t id : graph.fixed) text += fmt::format("{} {}\n", words.fix_tag, id);
  }
  for (const PoseGraph::Edge& edge : graph.edges) {
    text += fmt::format("{} {} {} {}", words.edge_tag, edge.i, edge.j, numbers_of(edge.T_i_j));
    for (const auto& [row, column] : words.information) {
      text += fmt::format(" {}", edge.information(row, column));
    }
    text += '\n';
  }
  return text;
}

Result<void> write_pose_graph(const PoseGraph& graph, const std::filesystem::path& path) {
  const auto format = graph_format_from_suffix(path);
  if (!format) {
    return fail(ErrorCode::kUnsupported, "unknown kind of graph", path.string(),
                "a name that ends in .g2o, .graph or .toro");
  }
  return write_file_atomically(path, pose_graph_text(graph, *format));
}

std::vector<std::string> losses_of_conversion(const PoseGraph& graph, GraphFormat target) {
  if (target == GraphFormat::kG2o || graph.fixed.empty()) return {};
  return {
      fmt::format("{} fixed poses: TORO holds its first pose and no other", graph.fixed.size())};
}

}  // namespace corridor::formats
