#include "datasets/formats/graphs/g2o_file.hpp"

#include <fmt/format.h>

#include <map>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/graphs/pose_graph_file.hpp"

namespace corridor::formats {
namespace {

std::vector<std::uint32_t> poses_of(const graph::Values& values) {
  std::vector<std::uint32_t> indices;
  for (const graph::Key key : values.keys()) {
    if (key.kind == graph::VariableKind::kPose) indices.push_back(key.index);
  }
  return indices;
}

// What the vocabulary of g2o's SE2 types cannot hold, by name and number.
void note_omissions(const std::map<std::string, std::size_t>& factors,
                    std::size_t num_other_variables, std::vector<std::string>& notes) {
  for (const auto& [type, count] : factors) {
    notes.push_back(fmt::format("left out: {} factors of type {}", count, type));
  }
  if (num_other_variables > 0) {
    notes.push_back(fmt::format("left out: {} variables that are not poses", num_other_variables));
  }
}

}  // namespace

PoseGraph pose_graph_of(const graph::FactorGraph& graph, const graph::Values& values) {
  PoseGraph written;
  std::set<std::uint32_t> poses_with_prior;
  std::map<std::string, std::size_t> left_out;
  std::map<graph::FactorId, PoseGraph::Edge> edges;  // by number: the graph keeps no order
  graph.for_each([&]<class F>(graph::FactorId id, const F& factor, const graph::RobustKernel&) {
    if constexpr (std::is_same_v<F, graph::RelativePose>) {
      edges.emplace(id, PoseGraph::Edge{factor.keys()[0].index, factor.keys()[1].index,
                                        factor.measured_T_i_j(), factor.information()});
    } else if constexpr (std::is_same_v<F, graph::PosePrior>) {
      poses_with_prior.insert(factor.keys()[0].index);
    } else {
      ++left_out[std::string(F::kName)];
    }
  });
  for (const auto& [id, edge] : edges) written.edges.push_back(edge);
  for (const std::uint32_t index : poses_of(values)) {
    written.vertices.push_back({index, values.pose(index)});
  }
  written.fixed.assign(poses_with_prior.begin(), poses_with_prior.end());
  if (written.fixed.empty() && !written.vertices.empty()) {
    written.fixed.push_back(written.vertices.front().id);
  }
  note_omissions(left_out, values.size() - written.vertices.size(), written.notes);
  for (const std::uint32_t index : poses_with_prior) {
    written.notes.push_back(fmt::format("pose {} has a prior; here it is fixed", index));
  }
  return written;
}

Result<void> write_g2o(const graph::FactorGraph& graph, const graph::Values& values,
                       const std::filesystem::path& path) {
  const PoseGraph written = pose_graph_of(graph, values);
  std::string comments;
  for (const std::string& note : written.notes) comments += fmt::format("# {}\n", note);
  return write_file_atomically(path, comments + pose_graph_text(written, GraphFormat::kG2o));
}

}  // namespace corridor::formats
