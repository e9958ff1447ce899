// Whether an estimator knows how wrong it is: the normalised estimation error squared (NEES) of the
// poses that it solved [BarShalom2001, sec. 5.4]. It judges covariances, not errors.
#pragma once

#include <cstdint>
#include <optional>

#include "slam/core/trajectory.hpp"
#include "slam/graph/graph_source.hpp"

namespace corridor::metrics {

// NEES of a pose: e^T P^-1 e, e (x_m, y_m, theta_rad) the true pose seen from the estimated one in
// its right tangent, first poses laid on each other, P the marginal covariance of the solved graph.
// A consistent estimator's has a chi-square distribution of `dof` degrees of freedom.
struct Consistency {
  double nees_mean = 0;  // over at most 50 poses along the run, which depend on each other
  double nees_last = 0;  // of the last pose
  std::int64_t dof = 3;
};

// nullopt where fewer than two solved poses have a true one, or the graph does not determine them.
std::optional<Consistency> score_consistency(const graph::GraphSource& source,
                                             const Trajectory& truth_world);

}  // namespace corridor::metrics
