// Central differences of a factor's whitened residual in the tangent of each of its variables.
#pragma once

#include <Eigen/Core>

#include "slam/graph/factor.hpp"

namespace corridor::testing {

// Step of the difference: its error is about step^2 * (third derivative) + rounding / step.
inline constexpr double kNumericStep = 1e-6;

inline Eigen::MatrixXd numeric_jacobian(const graph::Factor& factor, const graph::Values& values) {
  Eigen::MatrixXd jacobian(factor.dimension(), factor.num_columns());
  Eigen::VectorXd plus(factor.dimension()), minus(factor.dimension());
  int column = 0;
  for (const graph::Key key : factor.keys()) {
    for (int d = 0; d < key.dimension(); ++d, ++column) {
      Eigen::VectorXd delta = Eigen::VectorXd::Zero(key.dimension());
      delta(d) = kNumericStep;
      graph::Values moved = values;
      moved.retract(key, delta);
      factor.residual(moved, plus);
      moved = values;
      moved.retract(key, -delta);
      factor.residual(moved, minus);
      jacobian.col(column) = (plus - minus) / (2 * kNumericStep);
    }
  }
  return jacobian;
}

}  // namespace corridor::testing
