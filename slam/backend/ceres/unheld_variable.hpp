// Finds what no damping should hide: a part of a factor graph that nothing ties down.
#pragma once

#include <optional>

#include "slam/graph/factor_graph.hpp"
#include "slam/graph/variable_index.hpp"

namespace corridor::backend {

// A variable of a part (variables that factors join) which is undetermined whatever the numbers
// are: it has poses and no factor on one pose alone, so that it can be moved about as a whole, or
// no factor on one variable alone. What only the numbers can tell is not found: rows of zeros in a
// prior's information, a velocity that too few factors see.
std::optional<graph::Key> find_unheld_variable(const graph::FactorGraph& graph,
                                               const graph::VariableIndex& variables);

}  // namespace corridor::backend
