// What a back-end is told in an incremental run, call by call: the one shape into which pose graphs
// of files and recordings of systems are brought.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "slam/backend/back_end.hpp"
#include "slam/backend/initialization/spanning_order.hpp"
#include "slam/graph/values.hpp"

namespace corridor::solve {

// The calls of BackEnd that change what it holds.
enum class Call { kAdd, kUpdate, kSolve, kConverge, kSetValues, kMarginalize };

struct Step {
  // The newest pose, read when the step is done, how many poses there are by then, and whether an
  // update ends here: the steps since the one before are part of it.
  struct Reading {
    std::uint32_t pose = 0;
    std::size_t num_poses = 0;
    bool ends_update = true;
  };

  Call call = Call::kUpdate;
  std::vector<graph::NewFactor> factors;
  graph::Values values;
  // One more new pose, which starts where its edge leads from the back-end's own estimate.
  std::optional<backend::Placement> placement;
  // Factors of earlier steps, by their number among all factors as they came.
  std::vector<graph::FactorId> removed;
  std::vector<graph::Key> marginalized;  // of kMarginalize
  backend::ConvergenceBudget budget;     // of kConverge
  std::optional<Reading> reading;
};

struct Steps {
  std::size_t size = 0;
  // Asked for each once, in order, while no step's clock runs.
  std::function<Step(std::size_t)> at;
};

}  // namespace corridor::solve
