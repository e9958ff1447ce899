// Taking variables out of a factor graph without losing what was known through them.
#pragma once

#include <optional>
#include <span>

#include "slam/core/result.hpp"
#include "slam/graph/factor_graph.hpp"

namespace corridor::backend {

// What `factors`, linearised at `values`, say of their other variables once those of `eliminated`
// are marginalised out (Schur complement). `factors` has to hold every factor on an eliminated
// variable. Nothing if there are no other variables; an error if the eliminated ones are not
// determined even where the others are held.
Result<std::optional<graph::GaussianPrior>> marginal_prior(const graph::FactorGraph& graph,
                                                           const graph::Values& values,
                                                           std::span<const graph::FactorId> factors,
                                                           std::span<const graph::Key> eliminated);

}  // namespace corridor::backend
