// Central differences of a factor's whitened residual in the tangent of each of its variables.
#pragma once

#include <Eigen/Core>

#include "slam/graph/factor.hpp"

namespace corridor::testing {

// Step of the difference: its error is about step^2 * (third derivative) + rounding / step.
inline constexpr double kNumericStep = 1e-6;

template <class F>
graph::Jacobian<F> numeric_jacobian(const F& factor, const graph::Values& values) {
  graph::Residual<F> plus, minus;
  graph::Jacobian<F> jacobian;
  factor.linearize(values, plus, jacobian);  // for its size
  int column = 0;
  for (const graph::Key key : factor.keys()) {
    for (int d = 0; d < key.dimension(); ++d, ++column) {
      Eigen::VectorXd delta = kNumericStep * Eigen::VectorXd::Unit(key.dimension(), d);
      graph::Values moved = values;
      moved.retract(key, delta.data());
      factor.residual(moved, plus);
      moved = values;
      delta = -delta;
      moved.retract(key, delta.data());
      factor.residual(moved, minus);
      jacobian.col(column) = (plus - minus) / (2 * kNumericStep);
    }
  }
  return jacobian;
}

}  // namespace corridor::testing
