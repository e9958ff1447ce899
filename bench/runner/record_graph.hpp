// Runs a SLAM system over data to have the graph that it makes.
#pragma once

#include <cstddef>

#include "bench/runner/graph_of.hpp"
#include "bench/solve/recording.hpp"
#include "datasets/catalog/catalog.hpp"
#include "slam/core/result.hpp"

namespace corridor::runner {

struct RecordedGraph {
  solve::Recording recording;  // up to the last call that solves
  std::size_t num_dropped_factors = 0;
};

// With the system's own back-end. The Error: data that cannot be loaded, a system that cannot have
// them, fails, is lost or never has its graph solved.
Result<RecordedGraph> record_graph(const GraphOf& graph, const catalog::DataDirs& dirs);

}  // namespace corridor::runner
