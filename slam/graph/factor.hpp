// One term of the least-squares problem: min over X of sum_i || r_i(X_i) ||^2.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string_view>

#include "slam/graph/key.hpp"
#include "slam/graph/values.hpp"

namespace corridor::graph {

// Residuals are whitened: r = L^T e with Omega = L L^T the information matrix, so that chi2 =
// ||r||^2 (g2o's convention, no factor 1/2). Jacobians are with respect to the right tangent of
// each variable (Values::retract), stacked side by side in the order of keys().
class Factor {
 public:
  virtual ~Factor() = default;

  [[nodiscard]] virtual std::string_view type() const = 0;
  [[nodiscard]] virtual std::span<const Key> keys() const = 0;
  // Rows of the residual.
  [[nodiscard]] virtual int dimension() const = 0;
  // residual: dimension(); jacobian: dimension() x sum of the keys' dimensions. Both are
  // overwritten.
  virtual void linearize(const Values& values, Eigen::Ref<Eigen::VectorXd> residual,
                         Eigen::Ref<Eigen::MatrixXd> jacobian) const = 0;
  // The whitened residual alone.
  virtual void residual(const Values& values, Eigen::Ref<Eigen::VectorXd> residual) const = 0;

  // Sum of the keys' dimensions.
  [[nodiscard]] int num_columns() const;
  [[nodiscard]] double chi2(const Values& values) const;
};

using FactorPtr = std::unique_ptr<const Factor>;

}  // namespace corridor::graph
