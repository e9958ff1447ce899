// Sparse Cholesky factorisation of symmetric positive definite matrices through SuiteSparse CHOLMOD
// [Chen2008], with the fill-reducing ordering (AMD) computed on the graph of blocks, as g2o does.
// The symbolic analysis is kept while the pattern stays the same. Never throws, never prints.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <span>

namespace corridor::linear {

enum class CholeskyStatus {
  kOk,
  kNotPositiveDefinite,  // see first_bad_column()
  kOutOfMemory,
};

class SparseCholesky {
 public:
  SparseCholesky();
  ~SparseCholesky();
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;

  // lower: lower triangle of the matrix, n x n, compressed, row indices sorted in each column.
  // block_starts: first row of every variable's block, ascending, plus n at the end.
  CholeskyStatus factorize(const Eigen::SparseMatrix<double>& lower,
                           std::span<const int> block_starts);
  // x = A^-1 b; b is n x k. Requires a successful factorize().
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& b) const;

  // Scalar column (in the caller's order) at which the factorisation broke down; -1 if it did not.
  [[nodiscard]] int first_bad_column() const;
  // Nonzeros of the factor L.
  [[nodiscard]] double num_factor_nonzeros() const;
  // How often the symbolic analysis was done since construction.
  [[nodiscard]] int num_analyses() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace corridor::linear
