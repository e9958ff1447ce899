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

// Calls visit_key(a, J_a) for every key of a factor with its columns of the Jacobian, and
// visit_pair(a, b, J_a, J_b) for every pair with b <= a, b ascending within a. Sizes are constants
// where the type has them.
template <class F, class VisitKey, class VisitPair>
void for_each_block(const F& factor, const graph::Jacobian<F>& J, const VisitKey& visit_key,
                    const VisitPair& visit_pair) {
  if constexpr (graph::kIsFixed<F>) {
    const auto columns_of = [&J](auto key) {
      return J.template middleCols<graph::dimension_of(F::kKinds[key])>(
          graph::first_column<F>(key));
    };
    for_each_index<graph::kNumKeys<F>>([&](auto a) {
      visit_key(a, columns_of(a));
      for_each_index<a + 1>([&](auto b) { visit_pair(a, b, columns_of(a), columns_of(b)); });
    });
  } else {
    Eigen::Index column_a = 0;
    for (std::size_t a = 0; a < factor.keys().size(); ++a) {
      const auto J_a = J.middleCols(column_a, factor.keys()[a].dimension());
      visit_key(a, J_a);
      Eigen::Index column_b = 0;
      for (std::size_t b = 0; b <= a; ++b) {
        const auto J_b = J.middleCols(column_b, factor.keys()[b].dimension());
        visit_pair(a, b, J_a, J_b);
        column_b += J_b.cols();
      }
      column_a += J_a.cols();
    }
  }
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
