#include "slam/linear/make_linear_solver.hpp"

#include "slam/linear/block_cholesky.hpp"
#include "slam/linear/sparse_cholesky.hpp"

namespace corridor::linear {

std::string to_text(LinearSolverKind kind) { return std::string(make_linear_solver(kind)->name()); }

std::unique_ptr<LinearSolver> make_linear_solver(LinearSolverKind kind) {
  if (kind == LinearSolverKind::kBlock) return std::make_unique<BlockCholesky>();
  return std::make_unique<SparseCholesky>();
}

}  // namespace corridor::linear
