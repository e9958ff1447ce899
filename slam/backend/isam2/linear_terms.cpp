#include "slam/backend/isam2/linear_terms.hpp"

#include "slam/backend/weighted_terms.hpp"

namespace corridor::backend {

void add_linearized(const graph::FactorGraph& graph, graph::FactorId id,
                    const graph::Values& values, std::span<const int> variables,
                    const BayesTree& tree, Front& front) {
  graph.visit(id, [&]<class F>(const F& factor, const graph::RobustKernel& kernel) {
    graph::Residual<F> r;
    graph::Jacobian<F> J;
    front.add_chi2(linearize_weighted(factor, kernel, values, r, J));
    for_each_index<graph::kNumKeys<F>>([&](auto a) {
      const int row = tree.row_of(variables[a]);
      const auto J_a = columns_of<F, a>(J);
      front.add_gradient(row, (J_a.transpose() * r).eval());
      for_each_index<a + 1>([&](auto b) {
        front.add(row, tree.row_of(variables[b]), (J_a.transpose() * columns_of<F, b>(J)).eval());
      });
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
    for_each_index<graph::kNumKeys<F>>([&](auto a) {
      if (factor.keys()[a] != variable) return;
      constexpr int kDimension = graph::dimension_of(F::kKinds[a]);
      const auto J_a = columns_of<F, a>(J);
      information.topLeftCorner<kDimension, kDimension>() += J_a.transpose() * J_a;
    });
  });
}

}  // namespace corridor::backend
