#include "slam/linear/linear_solver.hpp"

#include <algorithm>
#include <cmath>
#include <new>

#include "slam/core/expect.hpp"
#include "slam/linear/minimum_degree.hpp"

namespace corridor::linear {

std::string to_text(CholeskyStatus status) {
  constexpr const char* kNames[] = {"ok", "not_positive_definite", "out_of_memory"};
  return kNames[static_cast<std::size_t>(status)];
}

bool FactorDiagonal::take(double entry, int row) {
  if (bad_row_ >= 0) return false;
  if (!(entry > 0 && std::isfinite(entry))) {
    bad_row_ = row;
    return false;
  }
  if (entry < smallest_) {
    smallest_ = entry;
    smallest_row_ = row;
  }
  largest_ = std::max(largest_, entry);
  return true;
}

int FactorDiagonal::bad_row() const {
  if (bad_row_ >= 0) return bad_row_;
  const double ratio = smallest_ / largest_;
  return ratio * ratio > kMinReciprocalCondition ? -1 : smallest_row_;
}

CholeskyStatus LinearSolver::factorize(const BlockMatrix& matrix, double damping) {
  CORRIDOR_EXPECT(matrix.num_variables() > 0 && damping >= 0);
  has_factor_ = false;
  first_bad_variable_ = -1;
  try {
    return try_factorize(matrix, damping);
  } catch (const std::bad_alloc&) {
    starts_.clear();
    return CholeskyStatus::kOutOfMemory;
  }
}

CholeskyStatus LinearSolver::try_factorize(const BlockMatrix& matrix, double damping) {
  if (!is_analyzed(matrix)) {
    analyze(matrix, minimum_degree_order(matrix.pattern()));
    pattern_ = matrix.pattern();
    starts_ = matrix.starts();
    ++num_analyses_;
  }
  const int bad_row = eliminate(matrix, damping);
  has_factor_ = bad_row < 0;
  if (has_factor_) return CholeskyStatus::kOk;
  const auto next = std::upper_bound(starts_.begin(), starts_.end(), bad_row);
  first_bad_variable_ = static_cast<int>(next - starts_.begin()) - 1;
  return CholeskyStatus::kNotPositiveDefinite;
}

void LinearSolver::solve(const Eigen::Ref<const Eigen::MatrixXd>& b,
                         Eigen::Ref<Eigen::MatrixXd> x) {
  CORRIDOR_EXPECT(has_factor_ && b.rows() == starts_.back());
  CORRIDOR_EXPECT(x.rows() == b.rows() && x.cols() == b.cols());
  substitute(b, x);
}

bool LinearSolver::is_analyzed(const BlockMatrix& matrix) const {
  return starts_ == matrix.starts() && pattern_ == matrix.pattern();
}

}  // namespace corridor::linear
