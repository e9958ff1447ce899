// Batch least squares on sparse Cholesky, the g2o way: Gauss-Newton, and Levenberg-Marquardt with
// Marquardt's scaling. [Konolige2010] section III, [Kuemmerle2011] (g2o).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "slam/backend/back_end.hpp"
#include "slam/core/params.hpp"

namespace corridor::backend {

struct LeastSquaresParams {
  // Levenberg-Marquardt instead of Gauss-Newton: what is made, not a number to tune.
  bool use_damping = false;
  int max_iterations = 20;
  double min_squared_step = 1e-16;      // stop when ||delta||^2 is below (m^2 and rad^2 mixed)
  double min_relative_decrease = 1e-6;  // stop when chi2 falls by less; 0 = never
  double initial_lambda = 1e-4;         // H := H + lambda * diag(H)
  double lambda_decrease = 0.5;         // after a successful step
  double lambda_increase = 2.0;         // after a failed one; itself doubled at each failure
  int update_iterations = 1;            // iterations of update(), which starts near the optimum
  // Both solve the same equations, block several times faster.
  std::string linear = "block";  // or cholmod

  template <class V>
  static void visit(LeastSquaresParams& p, V&& v) {
    v(ParamInfo{"max_iterations", "1", "limit of one solve()", 1, 1000}, p.max_iterations);
    v(ParamInfo{"min_squared_step", "1", "stop when the squared norm of the step is below", 0},
      p.min_squared_step);
    v(ParamInfo{"min_relative_decrease", "1", "stop when chi2 falls by a smaller share; 0 = never",
                0, 1},
      p.min_relative_decrease);
    v(ParamInfo{"initial_lambda", "1", "damping at the start of each solve()", 0},
      p.initial_lambda);
    v(ParamInfo{"lambda_decrease", "1", "factor after a successful step", 0, 1}, p.lambda_decrease);
    v(ParamInfo{"lambda_increase", "1", "factor after a failed step, doubled at each failure", 1},
      p.lambda_increase);
    v(ParamInfo{"update_iterations", "1", "limit of one update()", 1, 1000}, p.update_iterations);
    v(ParamInfo{"linear", "", "factorisation: block or cholmod"}, p.linear);
  }
  // Broken if there is no such factorisation.
  [[nodiscard]] std::vector<std::string> relations() const;
};

// name(): "gauss-newton" or "levenberg".
std::unique_ptr<BackEnd> make_least_squares(const LeastSquaresParams& params);

// The settings of [Konolige2010]'s SPA as its program ships: 40 iterations, no decrease test.
LeastSquaresParams spa_params();

}  // namespace corridor::backend
