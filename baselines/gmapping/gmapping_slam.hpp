// GMapping-style Rao-Blackwellised particle filter [Grisetti2007] as shipped: 30 particles, each
// with its own map, moved by sampled odometry, put on the best scan match, weighed by its
// likelihood; with published_params() as described: poses are drawn from the Gaussian proposal of
// [Grisetti2007] eq. 14-18. No loop closing, no IMU.
#pragma once

#include <memory>

#include "baselines/gmapping/gmapping_params.hpp"
#include "slam/core/rng.hpp"
#include "slam/core/robot_model.hpp"
#include "slam/core/slam_system.hpp"

namespace corridor::gmapping {

// Requires parameters without violations and num_threads >= 1; the estimate does not depend on
// num_threads. Online pose: the present pose of the particle with the largest log-likelihood over
// its whole history. finish(): that particle's path, unused scans filled in from odometry, and its
// map.
std::unique_ptr<SlamSystem> make_gmapping(const GmappingParams& params, const RobotModel& robot,
                                          Rng rng, int num_threads);

}  // namespace corridor::gmapping
