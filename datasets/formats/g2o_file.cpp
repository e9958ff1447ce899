#include "datasets/formats/g2o_file.hpp"

#include <fmt/format.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "datasets/formats/atomic_file.hpp"
#include "slam/graph/factors/pose_factors.hpp"

namespace corridor::formats {
namespace {

std::vector<std::uint32_t> poses_of(const graph::Values& values) {
  std::vector<std::uint32_t> indices;
  for (const graph::Key key : values.keys()) {
    if (key.kind == graph::VariableKind::kPose) indices.push_back(key.index);
  }
  return indices;
}

std::string vertex_lines(const std::vector<std::uint32_t>& poses, const graph::Values& values) {
  std::string lines;
  for (const std::uint32_t index : poses) {
    const Pose2& T_map_base = values.pose(index);
    lines += fmt::format("VERTEX_SE2 {} {} {} {}\n", index, T_map_base.x_m(), T_map_base.y_m(),
                         T_map_base.theta_rad());
  }
  return lines;
}

std::string edge_line(const graph::RelativePose& factor) {
  const auto keys = factor.keys();
  const Pose2& T_i_j = factor.measured_T_i_j();
  const Eigen::Matrix3d information = factor.information();
  std::string line = fmt::format("EDGE_SE2 {} {} {} {} {}", keys[0].index, keys[1].index,
                                 T_i_j.x_m(), T_i_j.y_m(), T_i_j.theta_rad());
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) {
      line += fmt::format(" {}", information(row, column));
    }
  }
  return line + "\n";
}

// What the vocabulary of g2o's SE2 types cannot hold, by name and number.
std::string omission_lines(const std::map<std::string, std::size_t>& factors,
                           std::size_t num_other_variables) {
  std::string lines;
  for (const auto& [type, count] : factors) {
    lines += fmt::format("# left out: {} factors of type {}\n", count, type);
  }
  if (num_other_variables > 0) {
    lines += fmt::format("# left out: {} variables that are not poses\n", num_other_variables);
  }
  return lines;
}

std::string fix_lines(const std::set<std::uint32_t>& poses_with_prior,
                      const std::vector<std::uint32_t>& poses) {
  std::string lines;
  for (const std::uint32_t index : poses_with_prior) {
    lines += fmt::format("# pose {} has a prior; here it is fixed\nFIX {}\n", index, index);
  }
  if (lines.empty() && !poses.empty()) lines = fmt::format("FIX {}\n", poses.front());
  return lines;
}

}  // namespace

Result<void> write_g2o(const graph::FactorGraph& graph, const graph::Values& values,
                       const std::filesystem::path& path) {
  std::string edges;
  std::set<std::uint32_t> poses_with_prior;
  std::map<std::string, std::size_t> left_out;
  for (const graph::FactorPtr& factor : graph.slots()) {
    if (factor == nullptr) continue;
    if (const auto* relative = dynamic_cast<const graph::RelativePose*>(factor.get())) {
      edges += edge_line(*relative);
    } else if (const auto* prior = dynamic_cast<const graph::PosePrior*>(factor.get())) {
      poses_with_prior.insert(prior->keys()[0].index);
    } else {
      ++left_out[std::string(factor->type())];
    }
  }
  const std::vector<std::uint32_t> poses = poses_of(values);
  return write_file_atomically(path, omission_lines(left_out, values.size() - poses.size()) +
                                         vertex_lines(poses, values) +
                                         fix_lines(poses_with_prior, poses) + edges);
}

}  // namespace corridor::formats
