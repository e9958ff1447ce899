#include "slam/backend/gauss_newton/normal_equations.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <type_traits>

#include "slam/backend/weighted_terms.hpp"

namespace corridor::backend {
void NormalEquations::add_variable(graph::Key key) {
  index_.add(key, blocks_.add_variable(key.dimension()));
}

void NormalEquations::add_factor(graph::FactorId id, const graph::FactorGraph& graph) {
  if (first_target_.size() <= id) {
    first_target_.resize(id + 1);
    first_row_.resize(id + 1);
  }
  first_target_[id] = targets_.size();
  first_row_[id] = rows_.size();
  const std::span<const graph::Key> keys = graph.keys(id);
  for (std::size_t a = 0; a < keys.size(); ++a) {
    const int row = index_.of(keys[a]);
    rows_.push_back(blocks_.starts()[static_cast<std::size_t>(row)]);
    for (std::size_t b = 0; b <= a; ++b) {
      const int column = index_.of(keys[b]);
      targets_.push_back(
          {blocks_.slot(std::max(row, column), std::min(row, column)), row < column});
    }
  }
}

template <class F>
void NormalEquations::add_terms(graph::FactorId id, const F& factor, const graph::Residual<F>& r,
                                const graph::Jacobian<F>& J) {
  const Target* target = &targets_[first_target_[id]];
  const int* row = &rows_[first_row_[id]];
  for_each_block(
      factor, J,
      [&](std::size_t a, const auto& J_a) {
        constexpr int kColumns = std::remove_cvref_t<decltype(J_a)>::ColsAtCompileTime;
        gradient_.segment<kColumns>(row[a], J_a.cols()).noalias() += J_a.transpose() * r;
      },
      [&](std::size_t, std::size_t, const auto& J_a, const auto& J_b) {
        if (target->is_transposed) {
          blocks_.add(target->slot, J_b.transpose().lazyProduct(J_a));
        } else {
          blocks_.add(target->slot, J_a.transpose().lazyProduct(J_b));
        }
        ++target;
      });
}

double NormalEquations::linearize(const graph::FactorGraph& graph, const graph::Values& values) {
  blocks_.set_zero();
  gradient_.setZero(blocks_.num_rows());
  double cost = 0;
  graph.for_each(
      [&]<class F>(graph::FactorId id, const F& factor, const graph::RobustKernel& kernel) {
        graph::Residual<F> r;
        graph::Jacobian<F> J;
        cost += linearize_weighted(factor, kernel, values, r, J);
        add_terms(id, factor, r, J);
      });
  // What is not finite in a Jacobian is not in the gradient either.
  return gradient_.allFinite() ? cost : std::numeric_limits<double>::quiet_NaN();
}

int NormalEquations::first_row(graph::Key key) const {
  return blocks_.starts()[static_cast<std::size_t>(index_.of(key))];
}

graph::Key NormalEquations::variable_of_row(int row) const {
  const auto& starts = blocks_.starts();
  const auto next = std::upper_bound(starts.begin(), starts.end(), row);
  return variables()[static_cast<std::size_t>(next - starts.begin()) - 1];
}

}  // namespace corridor::backend
