// Linearises a factor graph into H delta = -g with H = sum J^T J and g = sum J^T r, block by block.
// Keeps the structure between calls; factors and variables may be added, factors removed.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <vector>

#include "slam/graph/factor_graph.hpp"
#include "slam/graph/values.hpp"
#include "slam/linear/block_matrix.hpp"

namespace corridor::backend {

class NormalEquations {
 public:
  void add_variable(graph::Key key);
  // Requires that every key of the factor was added.
  void add_factor(graph::FactorId id, const graph::Factor& factor);

  // Evaluates every factor at `values`; returns chi2. Not finite if a residual or Jacobian is not.
  double linearize(const graph::FactorGraph& graph, const graph::Values& values);

  [[nodiscard]] const Eigen::VectorXd& gradient() const { return gradient_; }
  // H of the last linearize().
  [[nodiscard]] const linear::BlockMatrix& hessian() const { return blocks_; }
  [[nodiscard]] const std::vector<graph::Key>& variables() const { return variables_; }
  [[nodiscard]] bool contains(graph::Key key) const { return index_of_.contains(key); }
  // First scalar row of a variable. Requires contains(key).
  [[nodiscard]] int first_row(graph::Key key) const;
  // The variable that owns a scalar row.
  [[nodiscard]] graph::Key variable_of_row(int row) const;

 private:
  // Where the block of (keys[a], keys[b]) of a factor is summed, a >= b in matrix order.
  struct BlockTarget {
    std::size_t slot;
    int row_offset, num_rows;        // columns of the factor's Jacobian that make the block's rows
    int column_offset, num_columns;  // and its columns
  };
  struct FactorPlan {
    std::vector<BlockTarget> targets;
    std::vector<int> first_rows;  // per key, of the gradient
  };

  linear::BlockMatrix blocks_;
  std::map<graph::Key, int> index_of_;
  std::vector<graph::Key> variables_;
  std::vector<FactorPlan> plans_;  // by FactorId
  Eigen::VectorXd gradient_;
};

}  // namespace corridor::backend
