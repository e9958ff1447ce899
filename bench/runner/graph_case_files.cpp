#include "bench/runner/graph_case_files.hpp"

#include <fmt/format.h>

#include <string>
#include <unordered_map>
#include <utility>

#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/graphs/pose_graph_file.hpp"

namespace corridor::runner {
namespace {

namespace fs = std::filesystem;

constexpr double kMicroseconds = 1e6;

// The graph at these poses; poses that are not among them are left out, with their edges.
formats::PoseGraph graph_at(const formats::PoseGraph& graph, const Poses& poses) {
  std::unordered_map<std::uint32_t, Pose2> found;
  for (const formats::PoseGraph::Vertex& pose : poses) found[pose.id] = pose.T_map_base;
  formats::PoseGraph moved;
  for (const formats::PoseGraph::Vertex& vertex : graph.vertices) {
    const auto at = found.find(vertex.id);
    if (at != found.end()) moved.vertices.push_back({vertex.id, at->second});
  }
  for (const formats::PoseGraph::Edge& edge : graph.edges) {
    if (found.contains(edge.i) && found.contains(edge.j)) moved.edges.push_back(edge);
  }
  for (const std::uint32_t pose : graph.fixed) {
    if (found.contains(pose)) moved.fixed.push_back(pose);
  }
  return moved;
}

// Empty for what is not known.
std::string known(std::int64_t count) { return count > 0 ? fmt::format("{}", count) : ""; }

std::string updates_csv(const solve::SolveRun& run,
                        const std::vector<solve::Checkpoint>& checkpoints) {
  std::string text =
      "update,newest_pose,poses,time_us,relinearised,eliminated,factor_nonzeros,chi2,chi2_optimum,"
      "newest_gap_m,"
      "newest_gap_rad\n";
  auto checkpoint = checkpoints.begin();
  for (std::size_t k = 0; k < run.updates.size(); ++k) {
    const solve::Update& update = run.updates[k];
    text += fmt::format("{},{},{},{:.3f},{},{},{},", k, update.newest, update.num_poses,
                        kMicroseconds * run.updates_s[k], update.num_relinearized,
                        update.num_eliminated, known(update.num_factor_nonzeros));
    if (checkpoint != checkpoints.end() && checkpoint->update_index == k) {
      text += fmt::format("{},{},{},{}\n", checkpoint->chi2, checkpoint->chi2_optimum,
                          checkpoint->newest_gap_m, checkpoint->newest_gap_rad);
      ++checkpoint;
    } else {
      text += ",,,\n";
    }
  }
  return text;
}

}  // namespace

Result<void> write_graph_output(const fs::path& folder, const GraphOutput& output) {
  if (!output.final_poses->empty()) {
    auto done = formats::write_pose_graph(graph_at(*output.graph, *output.final_poses),
                                          folder / "final.g2o");
    if (!done) return done;
  }
  if (output.run->updates.empty()) return {};
  if (!output.online_poses->empty()) {
    auto done = formats::write_pose_graph(graph_at(*output.graph, *output.online_poses),
                                          folder / "online.g2o");
    if (!done) return done;
  }
  const std::string text = updates_csv(*output.run, *output.checkpoints);
  return formats::write_file_atomically(folder / "updates.csv", std::string_view(text));
}

}  // namespace corridor::runner
