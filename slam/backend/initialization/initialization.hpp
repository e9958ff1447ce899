// Initial values of a graph of relative poses, from its edges alone. Held poses (without any, the
// lowest) keep the value they have; every other pose of `values` gets a new one. Variables that
// are no poses, and factors that are no relative poses, do not count.
// The Error names a pose that no edges join to a held one, or that its edges leave undetermined,
// or says that numbers grow beyond all bounds.
#pragma once

#include <cstdint>
#include <span>

#include "slam/core/result.hpp"
#include "slam/graph/factor_graph.hpp"
#include "slam/graph/values.hpp"

namespace corridor::backend {

// Poses chained along the edges of spanning_order(): odometry, where there is some.
Result<graph::Values> odometry_initialization(const graph::FactorGraph& graph,
                                              const graph::Values& values,
                                              std::span<const std::uint32_t> held);

// [Carlone2015] section III.B, in the plane: headings as vectors x = (cos, sin), which solve
//   min sum w_ij || x_j - R(theta_ij) x_i ||^2,   w_ij the information of theta_ij,
// without |x| = 1 and are then scaled to it; after that positions by the least squares of all
// edges with these headings. Both problems are linear: no initial value is needed.
// Deviation: the second one solves for positions alone, not for a whole Gauss-Newton step, whose
// headings would move far positions by the curvature that the step leaves out.
Result<graph::Values> chordal_initialization(const graph::FactorGraph& graph,
                                             const graph::Values& values,
                                             std::span<const std::uint32_t> held);

}  // namespace corridor::backend
