#include "bench/cli/solve_tree.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "bench/cli/solve_request.hpp"
#include "bench/cli/staged_files.hpp"
#include "datasets/formats/atomic_file.hpp"

namespace corridor::cli {
namespace {

// "pose 10 with its edges to 9 and 2": what the last update brought.
std::string arrival_text(const formats::PoseGraph& graph, std::uint32_t newest) {
  std::set<std::uint32_t> neighbours;
  for (const formats::PoseGraph::Edge& edge : graph.edges) {
    if (edge.i == newest) neighbours.insert(edge.j);
    if (edge.j == newest) neighbours.insert(edge.i);
  }
  std::string text = fmt::format("pose {}", newest);
  for (auto neighbour = neighbours.begin(); neighbour != neighbours.end(); ++neighbour) {
    const bool is_last = std::next(neighbour) == neighbours.end();
    const char* const joint = neighbour == neighbours.begin() ? " joined to " : ", ";
    text += fmt::format("{}{}", is_last && neighbours.size() > 1 ? " and " : joint, *neighbour);
  }
  return text;
}

}  // namespace

Result<void> check_tree(const SolveCommand& command) {
  if (command.tree.empty()) return {};
  if (command.back_end != "isam2") {
    return fail(ErrorCode::kInvalid, command.back_end + " shows no Bayes tree", "--tree",
                "--backend isam2 with it");
  }
  if (!is_incremental(command)) {
    return fail(ErrorCode::kInvalid, "a batch solution has no updates", "--tree",
                "--mode incremental with it");
  }
  if (std::filesystem::path(command.tree).extension() != ".svg") {
    return fail(ErrorCode::kUnsupported, "unknown kind of picture", command.tree,
                "a name that ends in .svg");
  }
  for (const std::string& other : {command.graph, command.out, command.rejected}) {
    if (is_same_file(command.tree, other)) {
      return fail(ErrorCode::kInvalid, "this is another file of the request", command.tree,
                  "another name for the picture");
    }
  }
  return check_targets({command.tree});
}

Result<void> check_tree_size(const SolveCommand& command, const formats::PoseGraph& graph) {
  const std::size_t num_poses = graph.vertices.size();
  if (command.tree.empty() || num_poses <= kMaxPosesOfTree) return {};
  return fail(ErrorCode::kInvalid,
              fmt::format("the tree of {} poses would be too large to be read", num_poses),
              "--tree", fmt::format("a graph of at most {} poses", kMaxPosesOfTree));
}

void LastUpdate::watch(solve::SolveOptions& options) {
  options.after_update = [this](const solve::Moment& moment) {
    newest_ = moment.update.newest;
    before_ =
        std::exchange(after_, backend::tree_of(moment.back_end).value_or(backend::TreeSnapshot()));
  };
}

Result<void> LastUpdate::write(const SolveCommand& command, const formats::PoseGraph& graph,
                               const TreeDrawer& draw_tree) const {
  const std::string title =
      fmt::format("Bayes tree of {}: {}", std::filesystem::path(command.graph).filename().string(),
                  arrival_text(graph, newest_));
  return formats::write_file_atomically(command.tree, draw_tree(title, before_, after_));
}

}  // namespace corridor::cli
