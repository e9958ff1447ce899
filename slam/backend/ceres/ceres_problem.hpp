// A factor graph as Ceres sees it: a parameter block per variable, a residual block per factor.
// The cost functions name their factor by its number in the suite's graph and evaluate it there.
//
// A block of a pose is (x_m, y_m, theta_rad) in the map, and steps add to it; of other variables it
// is the value. Factors give Jacobians in the right tangent, t' = t + R dt: the ambient Jacobian
// is J_tangent * diag(R^T, 1), exact, and there is no manifold to multiply with. Before every
// evaluation all blocks are written into one Values, where the factors find cosine and sine.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "slam/graph/factor_graph.hpp"
#include "slam/graph/values.hpp"
#include "slam/graph/variable_index.hpp"

namespace ceres {
class Problem;
}

namespace corridor::backend {

class CeresProblem {
 public:
  // `graph` must outlive it.
  explicit CeresProblem(const graph::FactorGraph& graph);
  ~CeresProblem();
  CeresProblem(const CeresProblem&) = delete;
  CeresProblem& operator=(const CeresProblem&) = delete;

  void add_variable(graph::Key key);
  // Requires that the graph has the factor and that its variables, all different, were added.
  void add_factor(graph::FactorId id);
  // The factor may have left the graph already.
  void remove_factor(graph::FactorId id);

  [[nodiscard]] const graph::VariableIndex& variables() const;
  // Requires variables().contains(key).
  [[nodiscard]] const double* block(graph::Key key) const;
  // Copy every variable from `values` into its block, and back.
  void set_blocks(const graph::Values& values);
  void get_blocks(graph::Values& values) const;
  // Where the factors were evaluated last.
  [[nodiscard]] const graph::Values& last_point() const;

  [[nodiscard]] ceres::Problem& problem();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace corridor::backend
