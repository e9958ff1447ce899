// What a case that solves a graph leaves behind besides its record: final.g2o, and of an
// incremental solution online.g2o and updates.csv.
#pragma once

#include <filesystem>
#include <vector>

#include "bench/solve/gap_trace.hpp"
#include "bench/solve/solve_graph.hpp"
#include "datasets/formats/graphs/pose_graph.hpp"
#include "slam/core/result.hpp"

namespace corridor::runner {

using Poses = std::vector<formats::PoseGraph::Vertex>;  // in ascending order of their numbers

struct GraphOutput {
  const formats::PoseGraph* graph = nullptr;
  const solve::SolveRun* run = nullptr;
  const Poses* final_poses = nullptr;   // empty after a failure
  const Poses* online_poses = nullptr;  // as each was when it was the newest; empty of a batch
  const std::vector<solve::Checkpoint>* checkpoints = nullptr;
};

Result<void> write_graph_output(const std::filesystem::path& folder, const GraphOutput& output);

}  // namespace corridor::runner
