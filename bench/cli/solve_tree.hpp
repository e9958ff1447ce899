// The Bayes tree in `solve`: drawn before and after the last update.
#pragma once

#include <cstddef>

#include "bench/cli/solve_command.hpp"
#include "bench/solve/solve_graph.hpp"
#include "slam/backend/isam2/tree_snapshot.hpp"

namespace corridor::cli {

// A larger graph's tree cannot be read on a page; a tree has at most a clique per pose.
inline constexpr std::size_t kMaxPosesOfTree = 40;

// Whether --tree goes with the other options, and can be written.
Result<void> check_tree(const SolveCommand& command);
Result<void> check_tree_size(const SolveCommand& command, const formats::PoseGraph& graph);

// The tree at the last two steps of a solution. It stays where it is while that runs.
class LastUpdate {
 public:
  // Takes snapshots at these steps, with the clock stopped.
  void watch(solve::SolveOptions& options);
  Result<void> write(const SolveCommand& command, const formats::PoseGraph& graph,
                     const TreeDrawer& draw_tree) const;

 private:
  std::uint32_t newest_ = 0;
  backend::TreeSnapshot before_, after_;
};

}  // namespace corridor::cli
