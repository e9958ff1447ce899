// Factors as terms of a quadratic function: what they add to a front and to a variable's
// information.
#pragma once

#include <Eigen/Core>
#include <span>

#include "slam/backend/isam2/bayes_tree.hpp"
#include "slam/graph/factor_graph.hpp"

namespace corridor::backend {

// Linearises a factor and adds J^T J, J^T r and r^T r to the open front of the tree. variables:
// numbers of the factor's variables in the tree.
void add_linearized(const graph::FactorGraph& graph, graph::FactorId id,
                    const graph::Values& values, std::span<const int> variables,
                    const BayesTree& tree, Front& front);

// Adds J_v^T J_v of the factor to the top left block of the variable's dimension.
void add_information(const graph::FactorGraph& graph, graph::FactorId id,
                     const graph::Values& values, graph::Key variable,
                     Eigen::Matrix3d& information);

}  // namespace corridor::backend
