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
  }
  (std::make_index_sequence<kCount>());
}

// Calls visit(a, J_a) for every key of a factor with its columns of the Jacobian. Sizes are
// constants where the type has them.
template <class F, class Visit>
void for_each_key(const F& factor, const graph::Jacobian<F>& J, const Visit& visit) {
  if constexpr (graph::kIsFixed<F>) {
    for_each_index<graph::kNumKeys<F>>([&](auto a) {
      visit(a, J.template middleCols<graph::dimension_of(F::kKinds[a])>(graph::first_column<F>(a)));
    });
  } else {
    Eigen::Index column = 0;
    for (std::size_t a = 0; a < factor.keys().size(); ++a) {
      const auto J_a = J.middleCols(column, factor.keys()[a].dimension());
      visit(a, J_a);
      column += J_a.cols();
    }
  }
}

// Calls visit_key as for_each_key() does, and visit_pair(a, b, J_a, J_b) for every pair with
// b <= a, b ascending within a.
template <class F, class VisitKey, class VisitPair>
void for_each_block(const F& factor, const graph::Jacobian<F>& J, const VisitKey& visit_key,
                    const VisitPair& visit_pair) {
  for_each_key(factor, J, [&](auto a, const auto& J_a) {
    visit_key(a, J_a);
    for_each_key(factor, J, [&](auto b, const auto& J_b) {
      if (b <= a) visit_pair(a, b, J_a, J_b);
    });
  });
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
