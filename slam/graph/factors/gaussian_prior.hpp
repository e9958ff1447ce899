// A joint Gaussian prior on any number of variables: what is left of factors when some of their
// variables were marginalised out.
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "slam/graph/factor.hpp"

namespace corridor::graph {

// r = U delta + r_0, where delta is stacked from x_k (-) x_k0, the steps from the values at which
// the factors were linearised, in the right tangent of each variable.
class GaussianPrior {
 public:
  static constexpr std::string_view kName = "gaussian_prior";
  static constexpr int kRows = Eigen::Dynamic;

  // U has a column per scalar of the keys' variables, in their order; r_0 as many rows as U.
  // values: holds x_k0 of every key.
  GaussianPrior(std::vector<Key> keys, const Values& values, Eigen::MatrixXd sqrt_information,
                Eigen::VectorXd offset);
  // From the quadratic form delta^T H delta + 2 g^T delta, H symmetric positive semi-definite: U
  // and r_0 with U^T U = H, U^T r_0 = g. Eigenvalues up to 1e-15 of the largest count as zero.
  static GaussianPrior from_information(std::vector<Key> keys, const Values& values,
                                        const Eigen::MatrixXd& H, const Eigen::VectorXd& g);

  [[nodiscard]] const std::vector<Key>& keys() const { return keys_; }
  [[nodiscard]] int num_rows() const { return static_cast<int>(offset_.rows()); }
  void linearize(const Values& values, Eigen::VectorXd& r, Eigen::MatrixXd& J) const;
  void residual(const Values& values, Eigen::VectorXd& r) const;

 private:
  [[nodiscard]] Eigen::VectorXd step(const Values& values) const;

  std::vector<Key> keys_;
  Values origin_;
  Eigen::MatrixXd sqrt_information_;
  Eigen::VectorXd offset_;
};

}  // namespace corridor::graph
