#include "datasets/formats/graphs/true_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

constexpr const char* kLine = "three finite numbers: x y theta";

std::optional<Pose2> pose_from(const std::vector<std::string_view>& fields) {
  std::array<double, 3> numbers{};
  if (fields.size() != numbers.size()) return std::nullopt;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::optional<double> number = parse_double(fields[i]);
    if (!number || !std::isfinite(*number)) return std::nullopt;
    numbers[i] = *number;
  }
  return Pose2(numbers[0], numbers[1], numbers[2]);
}

}  // namespace

std::filesystem::path true_poses_beside(const std::filesystem::path& graph_file) {
  std::filesystem::path path = graph_file;
  return path.replace_extension(".truth-nodes.dat");
}

Result<std::vector<PoseGraph::Vertex>> parse_true_poses(std::string_view text,
                                                        const PoseGraph& graph,
                                                        const std::string& name) {
  std::vector<PoseGraph::Vertex> poses;
  for (const PoseGraph::Vertex& vertex : graph.vertices) poses.push_back({vertex.id, {}});
  std::sort(poses.begin(), poses.end(),
            [](const auto& left, const auto& right) { return left.id < right.id; });
  std::size_t num_lines = 0;
  std::size_t num_poses = 0;
  while (const auto line = take_line(text)) {
    ++num_lines;
    const auto fields = split_fields(*line);
    if (fields.empty()) continue;
    const std::optional<Pose2> pose = pose_from(fields);
    if (!pose) {
      return fail(ErrorCode::kMalformed, "not a true pose: " + quote(*line),
                  fmt::format("{}:{}", name, num_lines), kLine);
    }
    if (num_poses < poses.size()) poses[num_poses].T_map_base = *pose;
    ++num_poses;
  }
  if (num_poses != poses.size()) {
    return fail(ErrorCode::kInvalid, fmt::format("{} true poses", num_poses), name,
                fmt::format("{}, one per pose of the graph", poses.size()));
  }
  return poses;
}

Result<std::vector<PoseGraph::Vertex>> read_true_poses(const std::filesystem::path& path,
                                                       const PoseGraph& graph) {
  const Result<std::string> text = read_file_bytes(path);
  if (!text) return tl::make_unexpected(text.error());
  return parse_true_poses(*text, graph, path.string());
}

}  // namespace corridor::formats
