// Sparse Cholesky factorisation through SuiteSparse CHOLMOD [Chen2008], straight on the block
// matrix's storage.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string_view>
#include <vector>

#include "slam/linear/linear_solver.hpp"

namespace corridor::linear {

// Pose graphs have columns too short for BLAS: linear/cholmod/factorize_* of bench/micro.
enum class CholmodMethod {
  kSimplicial,  // column by column
  kSupernodal,  // dense blocks, through BLAS
  kAuto,        // CHOLMOD's choice: supernodal at 40 or more flops per nonzero of the factor
};

class SparseCholesky final : public LinearSolver {
 public:
  explicit SparseCholesky(CholmodMethod method = CholmodMethod::kSimplicial);
  ~SparseCholesky() override;

  [[nodiscard]] std::string_view name() const override { return "cholmod"; }
  [[nodiscard]] double num_factor_nonzeros() const override;
  [[nodiscard]] double num_flops() const override;

 private:
  void analyze(const BlockMatrix& matrix, const std::vector<int>& order) override;
  int eliminate(const BlockMatrix& matrix, double damping) override;
  void substitute(const Eigen::Ref<const Eigen::MatrixXd>& b,
                  Eigen::Ref<Eigen::MatrixXd>& x) override;

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace corridor::linear
