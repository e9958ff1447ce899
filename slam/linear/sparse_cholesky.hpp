// Sparse Cholesky factorisation through SuiteSparse CHOLMOD [Chen2008], straight on the block
// matrix's storage.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string_view>
#include <vector>

#include "slam/linear/linear_solver.hpp"

namespace corridor::linear {

enum class CholmodMethod {
  kSimplicial,  // column by column
  kSupernodal,  // dense blocks, through BLAS
  kAuto,        // supernodal from kSupernodalSwitch flops per nonzero of the factor
};

// Near CHOLMOD's own switch, 40. On graphs of 400 to 40,000 poses column by column was the faster
// one up to 37 flops per nonzero (2.7 against 4.2 ms), supernodal from 53 (0.83 against 0.93 ms).
inline constexpr double kSupernodalSwitch = 45;

class SparseCholesky final : public LinearSolver {
 public:
  explicit SparseCholesky(CholmodMethod method = CholmodMethod::kAuto);
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
