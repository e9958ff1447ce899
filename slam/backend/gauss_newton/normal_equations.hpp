// Linearises a factor graph into H delta = -g with H = sum w J^T J and g = sum w J^T r, block by
// block, where w is the weight that a factor's robust kernel gives it at its present residual.
// Keeps the structure between calls; factors and variables may be added, factors removed.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "slam/graph/factor_graph.hpp"
#include "slam/graph/values.hpp"
#include "slam/graph/variable_index.hpp"
#include "slam/linear/block_matrix.hpp"

namespace corridor::backend {

class NormalEquations {
 public:
  void add_variable(graph::Key key);
  // Requires that every key of the factor was added.
  void add_factor(graph::FactorId id, const graph::FactorGraph& graph);

  // Evaluates every factor at `values`; returns the cost, which is chi2 where no factor has a
  // kernel. Not finite if a residual or Jacobian is not.
  double linearize(const graph::FactorGraph& graph, const graph::Values& values);

  [[nodiscard]] const Eigen::VectorXd& gradient() const { return gradient_; }
  // H of the last linearize().
  [[nodiscard]] const linear::BlockMatrix& hessian() const { return blocks_; }
  [[nodiscard]] const std::vector<graph::Key>& variables() const { return index_.keys(); }
  [[nodiscard]] bool contains(graph::Key key) const { return index_.contains(key); }
  // First scalar row of a variable. Requires contains(key).
  [[nodiscard]] int first_row(graph::Key key) const;
  // The variable that owns a scalar row.
  [[nodiscard]] graph::Key variable_of_row(int row) const;

 private:
  // Of a pair of a factor's keys: the block that it is summed into, and which way round.
  struct Target {
    std::size_t slot;
    bool is_transposed;
  };
  template <class F>
  void add_terms(graph::FactorId id, const F& factor, const graph::Residual<F>& r,
                 const graph::Jacobian<F>& J);

  linear::BlockMatrix blocks_;
  graph::VariableIndex index_;
  // Of factor id, from first_target_[id] on: the pairs (a, b) of its keys with a >= b, b ascending
  // within a.
  std::vector<Target> targets_;
  std::vector<std::size_t> first_target_;
  // Of factor id, from first_row_[id] on: the scalar row of every key.
  std::vector<int> rows_;
  std::vector<std::size_t> first_row_;
  Eigen::VectorXd gradient_;
};

}  // namespace corridor::backend
