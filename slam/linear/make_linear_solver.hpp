// The linear solvers by name, for whoever takes one as a parameter.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "slam/linear/linear_solver.hpp"

namespace corridor::linear {

enum class LinearSolverKind {
  kCholmod,  // SparseCholesky
  kBlock,    // BlockCholesky
};
inline constexpr std::array kLinearSolvers = {LinearSolverKind::kCholmod, LinearSolverKind::kBlock};
// As LinearSolver::name().
std::string to_text(LinearSolverKind kind);

std::unique_ptr<LinearSolver> make_linear_solver(LinearSolverKind kind);

}  // namespace corridor::linear
