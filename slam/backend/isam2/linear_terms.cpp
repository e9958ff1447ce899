#include "slam/backend/isam2/linear_terms.hpp"

#include <type_traits>

#include "slam/backend/weighted_terms.hpp"

namespace corridor::backend {

void add_linearized(const graph::FactorGraph& graph, graph::FactorId id,
                    const graph::Values& values, std::span<const int> variables,
                    const BayesTree& tree, Front& front) {
  graph.visit(id, [&]<class F>(const F& factor, const graph::RobustKernel& kernel) {
    graph::Residual<F> r;
    graph::Jacobian<F> J;
    front.add_chi2(linearize_weighted(factor, kernel, values, r, J));
    for_each_block(
        factor, J,
        [&](std::size_t a, const auto& J_a) {
          front.add_gradient(tree.row_of(variables[a]), (J_a.transpose() * r).eval());
        },
        [&](std::size_t a, std::size_t b, const auto& J_a, const auto& J_b) {
          front.add(tree.row_of(variables[a]), tree.row_of(variables[b]),
                    (J_a.transpose() * J_b).eval());
        });
  });
}

void add_information(const graph::FactorGraph& graph, graph::FactorId id,
                     const graph::Values& values, graph::Key variable,
                     Eigen::Matrix3d& information) {
  graph.visit(id, [&]<class F>(const F& factor, const graph::RobustKernel& kernel) {
    graph::Residual<F> r;
    graph::Jacobian<F> J;
    linearize_weighted(factor, kernel, values, r, J);
    for_each_key(factor, J, [&](std::size_t a, const auto& J_a) {
      if (factor.keys()[a] != variable) return;
      constexpr int kColumns = std::remove_cvref_t<decltype(J_a)>::ColsAtCompileTime;
      information.topLeftCorner<kColumns, kColumns>(J_a.cols(), J_a.cols()).noalias() +=
          J_a.transpose() * J_a;
    });
  });
}

}  // namespace corridor::backend
