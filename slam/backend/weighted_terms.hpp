// A factor's residual and Jacobian under its robust kernel, and loops over its keys that the
// compiler unrolls: shared by all back-ends of our own.
#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "slam/graph/factor_graph.hpp"

namespace corridor::backend {

// Calls visit with every number 0 ... kCount - 1 as a constant.
template <std::size_t kCount, class Visit>
void for_each_index(const Visit& visit) {
  [&]<std::size_t... k>(std::index_sequence<k...>) {
    (visit(std::integral_constant<std::size_t, k>()), ...);
  }(std::make_index_sequence<kCount>());
}

// Columns of the Jacobian that belong to the key-th variable.
template <class F, std::size_t key, class Derived>
auto columns_of(const Eigen::MatrixBase<Derived>& J) {
  return J.template middleCols<graph::dimension_of(F::kKinds[key])>(graph::first_column<F>(key));
}

// Linearises; r and J are scaled by the square root of the kernel's weight. Returns the cost.
template <class F>
double linearize_weighted(const F& factor, const graph::RobustKernel& kernel,
                          const graph::Values& values, graph::Residual<F>& r,
                          graph::Jacobian<F>& J) {
  factor.linearize(values, r, J);
  if (kernel.kind == graph::KernelKind::kNone) return r.squaredNorm();
  const double s = r.squaredNorm();
  const double root = std::sqrt(kernel.weight(s));
  r *= root;
  J *= root;
  return kernel.cost(s);
}

}  // namespace corridor::backend
