#include "slam/backend/gauss_newton/normal_equations.hpp"

#include <algorithm>
#include <limits>

#include "slam/core/expect.hpp"

namespace corridor::backend {
namespace {

constexpr int kMaxRows = 16;
constexpr int kMaxColumns = 24;
using Residual = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxRows, 1>;
using Jacobian =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxRows, kMaxColumns>;

}  // namespace

void NormalEquations::add_variable(graph::Key key) {
  CORRIDOR_EXPECT(!contains(key));
  index_of_[key] = blocks_.add_variable(key.dimension());
  variables_.push_back(key);
}

void NormalEquations::add_factor(graph::FactorId id, const graph::Factor& factor) {
  CORRIDOR_EXPECT(factor.dimension() <= kMaxRows && factor.num_columns() <= kMaxColumns);
  FactorPlan plan;
  std::vector<int> indices, offsets;
  int offset = 0;
  for (const graph::Key key : factor.keys()) {
    indices.push_back(index_of_.at(key));
    offsets.push_back(offset);
    plan.first_rows.push_back(blocks_.starts()[static_cast<std::size_t>(indices.back())]);
    offset += key.dimension();
  }
  const auto keys = factor.keys();
  for (std::size_t a = 0; a < keys.size(); ++a) {
    for (std::size_t b = 0; b < keys.size(); ++b) {
      if (indices[a] < indices[b]) continue;
      plan.targets.push_back({blocks_.slot(indices[a], indices[b]), offsets[a], keys[a].dimension(),
                              offsets[b], keys[b].dimension()});
    }
  }
  if (plans_.size() <= id) plans_.resize(id + 1);
  plans_[id] = std::move(plan);
}

double NormalEquations::linearize(const graph::FactorGraph& graph, const graph::Values& values) {
  blocks_.set_zero();
  gradient_.setZero(blocks_.num_rows());
  double chi2 = 0;
  Residual r;
  Jacobian J;
  for (graph::FactorId id = 0; id < graph.slots().size(); ++id) {
    if (!graph.contains(id)) continue;
    const graph::Factor& factor = graph.factor(id);
    r.resize(factor.dimension());
    J.resize(factor.dimension(), factor.num_columns());
    factor.linearize(values, r, J);
    if (!r.allFinite() || !J.allFinite()) return std::numeric_limits<double>::quiet_NaN();
    chi2 += r.squaredNorm();
    const FactorPlan& plan = plans_[id];
    int column = 0;
    for (std::size_t k = 0; k < plan.first_rows.size(); ++k) {
      const int dimension = factor.keys()[k].dimension();
      gradient_.segment(plan.first_rows[k], dimension).noalias() +=
          J.middleCols(column, dimension).transpose() * r;
      column += dimension;
    }
    for (const BlockTarget& t : plan.targets) {
      blocks_.block(t.slot) += (J.middleCols(t.row_offset, t.num_rows).transpose())
                                   .lazyProduct(J.middleCols(t.column_offset, t.num_columns));
    }
  }
  return chi2;
}

int NormalEquations::first_row(graph::Key key) const {
  return blocks_.starts()[static_cast<std::size_t>(index_of_.at(key))];
}

graph::Key NormalEquations::variable_of_row(int row) const {
  const auto& starts = blocks_.starts();
  const auto next = std::upper_bound(starts.begin(), starts.end(), row);
  return variables_[static_cast<std::size_t>(next - starts.begin()) - 1];
}

}  // namespace corridor::backend
