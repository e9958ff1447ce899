// Solvers of A x = b for a symmetric positive definite matrix of blocks, by Cholesky factorisation.
// The variables are eliminated in an order of minimum degree; order and symbolic analysis are kept
// while the pattern stays the same. One thread. Never throws, never prints.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "slam/linear/block_matrix.hpp"
#include "slam/linear/block_pattern.hpp"

namespace corridor::linear {

enum class CholeskyStatus {
  kOk,
  kNotPositiveDefinite,  // or so near to it that no digit is right; see first_bad_variable()
  kOutOfMemory,
};
std::string to_text(CholeskyStatus status);

// Watches the diagonal of a factor L in the order of elimination. A matrix counts as not positive
// definite if an entry is not a positive finite number, or if the factor's reciprocal condition
// (smallest / largest entry)^2 is not above kMinReciprocalCondition.
class FactorDiagonal {
 public:
  // A solution would have no correct digit left: 4.5 times the rounding of a double.
  static constexpr double kMinReciprocalCondition = 1e-15;

  // Takes the next entry and its scalar row in the matrix; false if it is no positive number.
  bool take(double entry, int row);
  // Scalar row at which the matrix is not positive definite; -1 if it is.
  [[nodiscard]] int bad_row() const;

 private:
  double smallest_ = std::numeric_limits<double>::infinity(), largest_ = 0;
  int smallest_row_ = -1, bad_row_ = -1;
};

class LinearSolver {
 public:
  LinearSolver() = default;
  LinearSolver(const LinearSolver&) = delete;
  LinearSolver& operator=(const LinearSolver&) = delete;
  virtual ~LinearSolver() = default;

  [[nodiscard]] virtual std::string_view name() const = 0;

  // Factorises the matrix with its diagonal times (1 + damping) [Marquardt1963]. Requires a
  // variable, damping >= 0, and a set_zero() after the last change of the matrix's structure.
  CholeskyStatus factorize(const BlockMatrix& matrix, double damping = 0);
  // x = A^-1 b, both n x k in the order of the matrix. Requires that the last factorize() was good.
  void solve(const Eigen::Ref<const Eigen::MatrixXd>& b, Eigen::Ref<Eigen::MatrixXd> x);

  // Variable at which the last factorisation broke down; -1 if it did not.
  [[nodiscard]] int first_bad_variable() const { return first_bad_variable_; }
  // How often the symbolic analysis was done since construction.
  [[nodiscard]] int num_analyses() const { return num_analyses_; }
  // Of the factor L by the last analysis: for "block" with the zeros that its supernodes fill, for
  // "cholmod" without.
  [[nodiscard]] virtual double num_factor_nonzeros() const = 0;
  // Multiplications and additions of a factorisation, by the last analysis.
  [[nodiscard]] virtual double num_flops() const = 0;

 private:
  // The symbolic analysis; may throw std::bad_alloc. order: the variable at every place.
  virtual void analyze(const BlockMatrix& matrix, const std::vector<int>& order) = 0;
  // The numbers, for the pattern of the last analyze(); may throw std::bad_alloc. Scalar row at
  // which the matrix is not positive definite; -1 if it is.
  virtual int eliminate(const BlockMatrix& matrix, double damping) = 0;
  virtual void substitute(const Eigen::Ref<const Eigen::MatrixXd>& b,
                          Eigen::Ref<Eigen::MatrixXd>& x) = 0;

  [[nodiscard]] bool is_analyzed(const BlockMatrix& matrix) const;
  CholeskyStatus try_factorize(const BlockMatrix& matrix, double damping);

  BlockPattern pattern_;     // of the last analysis,
  std::vector<int> starts_;  // and its scalar rows; empty without one
  int num_analyses_ = 0;
  int first_bad_variable_ = -1;
  bool has_factor_ = false;
};

}  // namespace corridor::linear
