// Robust kernels and methods that reject loop closures, under the names that users give.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench/solve/solve_graph.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"

namespace corridor::solve {

// Kernels, "none" first, then methods that reject edges: "none huber cauchy geman-mcclure dcs gnc
// gnc-geman-mcclure pcm".
std::vector<std::string> robust_methods();

// Of a method that rejects edges; kNone for a kernel. Requires one of robust_methods().
Rejection rejection_of(std::string_view method);

// `width` in standard deviations, for kernels. Requires one of robust_methods().
void set_robust_method(std::string_view method, double width, SolveOptions& options);

// Of the weighted solutions of kGnc, made from what solves the whole: the next begins where the
// last one ends, and what follows them is solved to the end.
backend::LeastSquaresParams round_settings(backend::LeastSquaresParams settings);

}  // namespace corridor::solve
