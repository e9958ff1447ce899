// Where on a system's map the points of the true walls should lie.
// A map may have shrunk by metres, so a wall is expected where the robot that saw it believed it
// was: a point q of a true wall, seen in scan i, was put down by a consistent system at
//   T_map_base_i * T_world_base_i^-1 * q.
// The map itself is never looked at.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bench/metrics/association.hpp"
#include "datasets/simulation/world.hpp"

namespace corridor::metrics {

struct BelievedPoint {
  Eigen::Vector2d point_world_m = Eigen::Vector2d::Zero();  // q
  // Median of each coordinate over the scans that saw q.
  Eigen::Vector2d point_map_m = Eigen::Vector2d::Zero();
  // How far those scans disagree: half the distance between the 16th and the 84th percentile of
  // the believed positions across the wall. The standard deviation if they are normally
  // distributed, half the gap if half of the scans put the wall elsewhere.
  double disagreement_m = 0;
};

// Points every 10 cm or less on all walls, without those that no scan saw within lidar_range_m.
std::vector<BelievedPoint> believe_walls(std::span<const MatchedPose> pairs,
                                         const simulation::World& world, double lidar_range_m);

}  // namespace corridor::metrics
