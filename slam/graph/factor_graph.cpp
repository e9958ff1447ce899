#include "slam/graph/factor_graph.hpp"

#include <utility>

#include "slam/core/expect.hpp"

namespace corridor::graph {

int Factor::num_columns() const {
  int columns = 0;
  for (const Key key : keys()) columns += key.dimension();
  return columns;
}

double Factor::chi2(const Values& values) const {
  constexpr int kMaxRows = 16;
  CORRIDOR_EXPECT(dimension() <= kMaxRows);
  Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxRows, 1> r(dimension());
  residual(values, r);
  return r.squaredNorm();
}

FactorId FactorGraph::add(FactorPtr factor) {
  CORRIDOR_EXPECT(factor != nullptr);
  factors_.push_back(std::move(factor));
  ++num_factors_;
  return factors_.size() - 1;
}

void FactorGraph::remove(FactorId id) {
  CORRIDOR_EXPECT(contains(id));
  factors_[id].reset();
  --num_factors_;
}

double FactorGraph::chi2(const Values& values) const {
  double sum = 0;
  for (const FactorPtr& factor : factors_) {
    if (factor) sum += factor->chi2(values);
  }
  return sum;
}

}  // namespace corridor::graph
