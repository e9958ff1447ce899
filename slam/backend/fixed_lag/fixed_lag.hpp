// A fixed-lag smoother: Isam2 on the newest poses. What is older is marginalised into a prior on
// what stays, so that an update costs and keeps what the window does, however long the drive.
//
// It deliberately closes no loop to a pose that left the window: a factor on one is left out and
// counted (BackEndReport::num_dropped_factors), as is the removal of a factor that the prior holds
// already. estimate() and pose() keep the last value of every variable that left, which is all that
// grows.
#pragma once

#include <memory>

#include "slam/backend/isam2/isam2.hpp"

namespace corridor::backend {

struct FixedLagParams {
  // The poses in the window after each update or solution. Velocities and biases leave with them,
  // any other variable once no factor named it for as long.
  int lag = 100;
  Isam2Params isam2;

  template <class V>
  static void visit(FixedLagParams& p, V&& v) {
    v(ParamInfo{"lag", "1", "newest poses that are kept and solved", 1, 1e6}, p.lag);
    Isam2Params::visit(p.isam2, v);
  }
};

// name(): "fixed-lag".
std::unique_ptr<BackEnd> make_fixed_lag(const FixedLagParams& params);

}  // namespace corridor::backend
