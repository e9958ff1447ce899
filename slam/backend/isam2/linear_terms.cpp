#include "slam/backend/isam2/linear_terms.hpp"

#include "slam/backend/weighted_terms.hpp"

namespace corridor::backend {

namespace {

// H += J_v^T J_v.
template <class Columns>
void add_square(const Columns& J_v, InformationTable::Block H) {
  constexpr int kColumns = Columns::ColsAtCompileTime;
  H.topLeftCorner<kColumns, kColumns>(J_v.cols(), J_v.cols()).noalias() += J_v.transpose() * J_v;
}

}  // namespace

void add_linearized(const graph::FactorGraph& graph, graph::FactorId id,
                    const graph::Values& values, std::span<const int> variables,
                    const BayesTree& tree, Front& front, InformationTable& information) {
  graph.visit(id, [&]<class F>(const F& factor, const graph::RobustKernel& kernel) {
    graph::Residual<F> r;
    graph::Jacobian<F> J;
    front.add_chi2(linearize_weighted(factor, kernel, values, r, J));
    for_each_block(
        factor, J,
        [&](std::size_t a, const auto& J_a) {
          front.add_gradient(tree.row_of(variables[a]), (J_a.transpose() * r).eval());
          if (!graph::kIsLinear<F> &&
              information.state(variables[a]) == InformationTable::State::kBeingSummed) {
            add_square(J_a, information.H(variables[a]));
          }
        },
        [&](std::size_t a, std::size_t b, const auto& J_a, const auto& J_b) {
          front.add(tree.row_of(variables[a]), tree.row_of(variables[b]),
                    (J_a.transpose() * J_b).eval());
        });
  });
}

void add_information(const graph::FactorGraph& graph, graph::FactorId id,
                     const graph::Values& values, graph::Key variable, InformationTable::Block H) {
  graph.visit(id, [&]<class F>(const F& factor, const graph::RobustKernel& kernel) {
    if (graph::kIsLinear<F>) return;
    graph::Residual<F> r;
    graph::Jacobian<F> J;
    linearize_weighted(factor, kernel, values, r, J);
    for_each_key(factor, J, [&](std::size_t a, const auto& J_a) {
      if (factor.keys()[a] == variable) add_square(J_a, H);
    });
  });
}

}  // namespace corridor::backend
