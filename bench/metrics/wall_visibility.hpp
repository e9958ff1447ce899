// Which points of the true walls the robot saw, and from where.
// Visibility only: range and occlusion, as an ideal LiDAR at the robot's base; no noise, no beam
// pattern.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "datasets/simulation/world.hpp"
#include "slam/core/pose2.hpp"

namespace corridor::metrics {

struct WallPoint {
  Eigen::Vector2d point_world_m = Eigen::Vector2d::Zero();
  std::size_t surface_index = 0;  // as World counts them
};

// Every wall is cut into equal pieces of at most spacing_m (> 0); their midpoints. A wall without
// length has none.
std::vector<WallPoint> sample_walls(const simulation::World& world, double spacing_m);

// For each point the indices of the poses that saw it, ascending: within range_m and with no wall
// between.
std::vector<std::vector<std::uint32_t>> find_sightings(std::span<const WallPoint> points,
                                                       const simulation::World& world,
                                                       std::span<const Pose2> T_world_base,
                                                       double range_m);

}  // namespace corridor::metrics
