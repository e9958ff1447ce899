// What `solve` was asked for: checked, and as the options of a solution.
#pragma once

#include "bench/cli/solve_command.hpp"
#include "bench/solve/solve_graph.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/core/params.hpp"

namespace corridor::cli {

bool is_incremental(const SolveCommand& command);
// These solve by slam/linear; the others bring a factorisation of their own.
bool has_linear_solver(const SolveCommand& command);

// Options that do not go together, and targets that cannot be written.
Result<void> check_request(const SolveCommand& command);

// What --set, --linear and --lag say of the back-end's parameters, each once.
Result<ParamValues> overrides_of(const SolveCommand& command);

solve::SolveOptions options_of(const SolveCommand& command);
backend::LeastSquaresParams settings_of_solve();

}  // namespace corridor::cli
