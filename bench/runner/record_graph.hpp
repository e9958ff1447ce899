// Runs a SLAM system over data to have the graph that it makes.
#pragma once

#include "bench/runner/graph_of.hpp"
#include "bench/solve/recording.hpp"
#include "datasets/catalog/catalog.hpp"
#include "slam/core/result.hpp"

namespace corridor::runner {

// With the system's own back-end. The Error: data that cannot be loaded, a system that cannot have
// them, fails, is lost or calls no back-end.
Result<solve::Recording> record_graph(const GraphOf& graph, const catalog::DataDirs& dirs);

}  // namespace corridor::runner
