// Ceres Solver [Agarwal2022] on the suite's own factors: a trust-region solver that shares with the
// back-ends of our own the factors' residuals and Jacobians and nothing behind them, so that it is
// rival and independent optimum at once.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "slam/backend/back_end.hpp"
#include "slam/core/params.hpp"

namespace corridor::backend {

// Levenberg-Marquardt with SPARSE_NORMAL_CHOLESKY and num_threads = 1; defaults are those of Ceres.
// Its cost is half of ours, which no relative tolerance notices.
struct CeresParams {
  int max_iterations = 50;
  int update_iterations = 1;          // iterations of update(), which starts near the optimum
  double function_tolerance = 1e-6;   // stop when the cost falls by a smaller share
  double gradient_tolerance = 1e-10;  // stop when the largest entry of the gradient is below
  double parameter_tolerance = 1e-8;  // stop when the step is a smaller share of all variables
  double initial_trust_region_radius = 1e4;     // 1 / lambda of Marquardt's scaling
  std::string sparse_library = "SUITE_SPARSE";  // or CX_SPARSE, EIGEN_SPARSE
  bool use_one_thread = false;  // for CHOLMOD as well, whose own threads Ceres does not limit

  template <class V>
  static void visit(CeresParams& p, V&& v) {
    v(ParamInfo{"max_iterations", "1", "limit of one solve()", 1, 1000}, p.max_iterations);
    v(ParamInfo{"update_iterations", "1", "limit of one update()", 1, 1000}, p.update_iterations);
    v(ParamInfo{"function_tolerance", "1", "stop when the cost falls by a smaller share", 0, 1},
      p.function_tolerance);
    v(ParamInfo{"gradient_tolerance", "1", "stop when no entry of the gradient is larger", 0},
      p.gradient_tolerance);
    v(ParamInfo{"parameter_tolerance", "1",
                "stop when the step is a smaller share of the variables", 0, 1},
      p.parameter_tolerance);
    v(ParamInfo{"initial_trust_region_radius", "1",
                "1 / damping at the start of each solve(); 1e16 = Gauss-Newton", 1e-32, 1e16},
      p.initial_trust_region_radius);
    v(ParamInfo{"sparse_library", "", "Cholesky of SUITE_SPARSE, CX_SPARSE or EIGEN_SPARSE"},
      p.sparse_library);
    v(ParamInfo{"use_one_thread", "", "keep CHOLMOD, which opens four threads of its own, on one"},
      p.use_one_thread);
  }
  // Broken if this Ceres was built without the library.
  [[nodiscard]] std::vector<std::string> relations() const;
};

// name(): "ceres".
std::unique_ptr<BackEnd> make_ceres(const CeresParams& params);

// The fastest settings found on recorded pose graphs: the trust region wide open, which makes it
// Gauss-Newton as long as steps succeed, and CHOLMOD on one thread; stopped by a relative decrease
// of 1e-9, or a step of 1e-12 of all variables. CXSparse is as fast on small
// graphs and falls behind on large ones (10,000 poses with 30,000 edges: 0.74 against 0.30 s).
CeresParams tuned_ceres_params();

}  // namespace corridor::backend
