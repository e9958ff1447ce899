// Graduated non-convexity [Yang2020]: least squares with a bounded loss, reached from a convex one
// in small steps. Alternates, with w the weights of the suspects,
//   X <- argmin sum_i w_i ||r_i(X)||^2 (a back-end),   w <- argmin w_i r_i^2 + Phi_mu(w_i),
//   mu <- the next,
// until every weight is 0 or 1, or the cost stands still. c^2 is the quantile of chi-squared that
// the squared whitened residual of a true factor exceeds with probability 1 - inlier_probability;
// its degrees of freedom are the rows of the factor.
//
//   kTruncated      w by eq. 14; mu_0 = c^2 / (2 r_max^2 - c^2), times mu_factor (remark 5)
//   kGemanMcClure   w = (mu c^2 / (r^2 + mu c^2))^2, eq. 12; mu_0 = 2 r_max^2 / c^2, divided, to 1
//
// with r_max^2 / c^2 the largest of the suspects after the first solution, in which all weights
// are 1. It never asks which factors may be false: that is the caller's knowledge.
// Deviation: a weight is binary when eq. 14 says exactly 0 or 1, not when it is near: with
// residuals of many bounds every weight is near 0 in the first rounds.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "slam/backend/back_end.hpp"
#include "slam/core/params.hpp"

namespace corridor::backend {

enum class GncLoss { kTruncated, kGemanMcClure };

struct GncParams {
  double inlier_probability = 0.99;     // of a true factor's residual to be below the bound
  double mu_factor = 1.4;               // [Yang2020] remark 5
  int max_rounds = 500;                 // mu grows by 1e73 until then
  double min_relative_decrease = 1e-5;  // of the weighted cost, at which the rounds stop

  template <class V>
  static void visit(GncParams& p, V&& v) {
    v(ParamInfo{"inlier_probability", "1", "share of true factors below the inlier bound", 0.5,
                0.999999},
      p.inlier_probability);
    v(ParamInfo{"mu_factor", "1", "growth of convexity's parameter per round", 1.01, 10},
      p.mu_factor);
    v(ParamInfo{"max_rounds", "1", "limit of weighted solutions", 1, 10000}, p.max_rounds);
    v(ParamInfo{"min_relative_decrease", "1", "stop when the weighted cost changes by less", 0, 1},
      p.min_relative_decrease);
  }
};

// A back-end without factors, with the settings of the caller.
using MakeBackEnd = std::function<std::unique_ptr<BackEnd>()>;

enum class GncStatus {
  kConverged,    // every weight is 0 or 1, the cost stands still, or mu has reached its end
  kMaxRounds,    // stopped by the limit of rounds
  kNotSolvable,  // a weighted problem had no solution; `solution` says why, `values` are the last
};

struct GncResult {
  GncStatus status = GncStatus::kConverged;
  BackEndReport solution;  // of the last round
  int num_rounds = 0;
  int num_iterations = 0;                 // of the back-end, over all rounds
  std::vector<double> weights;            // of `suspects`, in their order
  std::vector<graph::FactorId> rejected;  // suspects whose weight is below that at the bound
  graph::Values values;
};

// Factors that are not among `suspects` count in full, with their kernels; those of suspects are
// replaced by their weights. Suspects of weight 0 are not given to the back-end, so that false ones
// do not fill its factorisation.
GncResult graduated_non_convexity(const graph::FactorGraph& graph, const graph::Values& initial,
                                  std::span<const graph::FactorId> suspects, GncLoss loss,
                                  const MakeBackEnd& make_back_end, const GncParams& params);

// The kernel under which a factor counts with a weight in (0, 1].
graph::RobustKernel kernel_of_weight(double weight);

// Weight of a squared residual, in units of its bound (ratio = r^2 / c^2), in [0, 1].
double gnc_weight(GncLoss loss, double ratio, double mu);

}  // namespace corridor::backend
