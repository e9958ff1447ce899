// Factors as terms of a quadratic function: what they add to a front and, where it depends on the
// point of linearisation, to a variable's information.
#pragma once

#include <Eigen/Core>
#include <span>

#include "slam/backend/isam2/bayes_tree.hpp"
#include "slam/backend/isam2/variable_information.hpp"
#include "slam/graph/factor_graph.hpp"

namespace corridor::backend {

// Linearises a factor and adds J^T J, J^T r and r^T r to the open front of the tree, and J_v^T J_v
// to the information of those of its variables for which it is being summed. variables: numbers of
// the factor's variables in the tree.
void add_linearized(const graph::FactorGraph& graph, graph::FactorId id,
                    const graph::Values& values, std::span<const int> variables,
                    const BayesTree& tree, Front& front, InformationTable& information);

// Linearises a factor and adds its J_v^T J_v of one variable. A linear factor adds none.
void add_information(const graph::FactorGraph& graph, graph::FactorId id,
                     const graph::Values& values, graph::Key variable, InformationTable::Block H);

}  // namespace corridor::backend
