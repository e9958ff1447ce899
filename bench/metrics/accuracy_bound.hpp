// The error that no unbiased estimator falls below on one simulated log: the posterior Cramer-Rao
// bound [VanTrees1968, sec. 2.4] of its trajectory, from the information of all sensors at the true
// states. Computed once per log; it runs no SLAM and knows no measured range but to tell which
// beams met a wall.
#pragma once

#include <optional>
#include <span>

#include "datasets/simulation/truth.hpp"
#include "datasets/simulation/world.hpp"
#include "slam/core/sensor_log.hpp"

namespace corridor::metrics {

// Roots of the mean over the log's scans, first poses laid on each other as in position_rmse_m and
// angle_rmse_deg.
struct AccuracyBound {
  double position_rmse_m = 0;
  double angle_rmse_deg = 0;
};

// Known: which surface each beam met, the noise of every sensor as log.robot states it, when wheels
// slipped, and that the robot moves along its heading. Unknown: where the surfaces are (a wall's
// distance and angle, an arc's centre), the motion, the wheels' scale, unbalance and track, the
// IMU's biases and the gyro's scale, each with a wide prior. Not counted: ends of walls, and what
// no return says. nullopt where the log has fewer than two true poses, or a pose that nothing
// determines.
std::optional<AccuracyBound> accuracy_bound(const SensorLog& log, const simulation::World& world,
                                            std::span<const simulation::SlipInterval> slips);

}  // namespace corridor::metrics
