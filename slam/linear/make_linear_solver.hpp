// The linear solvers by name, for whoever takes one as a parameter.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "slam/linear/linear_solver.hpp"

namespace corridor::linear {

enum class LinearSolverKind {
  kCholmod,  // SparseCholesky
  kBlock,    // BlockCholesky
};
// As LinearSolver::name().
std::string to_text(LinearSolverKind kind);
std::optional<LinearSolverKind> linear_solver_from_text(std::string_view text);

std::unique_ptr<LinearSolver> make_linear_solver(LinearSolverKind kind);

}  // namespace corridor::linear
