// What a finished graph-based system solved, so that any back-end can solve exactly the same
// problem.
#pragma once

#include <vector>

#include "slam/core/timestamp.hpp"
#include "slam/graph/factor_graph.hpp"
#include "slam/graph/values.hpp"

namespace corridor::graph {

class GraphSource {
 public:
  virtual ~GraphSource() = default;
  // Valid after SlamSystem::finish().
  [[nodiscard]] virtual const FactorGraph& solved_graph() const = 0;
  [[nodiscard]] virtual const Values& solved_values() const = 0;
  // Of the scans that poses 0, 1, 2, ... stand for. Poses of higher numbers are of no scan.
  [[nodiscard]] virtual std::vector<Timestamp> pose_stamps() const = 0;
};

}  // namespace corridor::graph
