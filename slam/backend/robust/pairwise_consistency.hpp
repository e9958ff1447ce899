// Pairwise consistency maximisation [Mangelson2018]: of the loop closures, the largest set of which
// every two agree along odometry. Two closures z_ik, z_jl agree if the way k -> i -> j -> l -> k,
//   e = Log(z_ik^-1 T_i_j z_jl T_l_k)   (eq. 8),   e^T Sigma^-1 e <= c^2,
// comes back within the uncertainty Sigma of its four parts; c^2 is a quantile of chi-squared with
// three degrees of freedom. As published, the two ways along odometry count as independent. It
// needs no solution and no initial values, and it cannot see closures that are false together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slam/backend/robust/maximum_clique.hpp"
#include "slam/backend/robust/odometry_tree.hpp"
#include "slam/core/params.hpp"

namespace corridor::backend {

struct PcmParams {
  double inlier_probability = 0.99;  // of two true closures to agree
  // Of the search for a larger set: with some thousand closures a branch takes up to a
  // millisecond.
  int max_branches = 1000;

  template <class V>
  static void visit(PcmParams& p, V&& v) {
    v(ParamInfo{"inlier_probability", "1", "share of pairs of true closures that agree", 0.5,
                0.999999},
      p.inlier_probability);
    v(ParamInfo{"max_branches", "1", "limit of the search for a larger consistent set", 1, 1e9},
      p.max_branches);
  }
};

struct PcmResult {
  std::vector<graph::FactorId> rejected;  // of the closures that were given, in their order
  bool is_proven = false;                 // no larger consistent set exists
};

// e^T Sigma^-1 e of two closures; symmetric to first order.
double inconsistency(const graph::RelativePose& closure_ik, const UncertainPose& z_ik,
                     const graph::RelativePose& closure_jl, const UncertainPose& z_jl,
                     const OdometryTree& odometry);

// Time and memory grow with the square of the number of closures. The Error is that of
// OdometryTree::of(), or names a closure without covariance.
Result<PcmResult> pairwise_consistency(const graph::FactorGraph& graph, const graph::Values& values,
                                       std::span<const std::uint32_t> held,
                                       std::span<const graph::FactorId> closures,
                                       const PcmParams& params);

}  // namespace corridor::backend
