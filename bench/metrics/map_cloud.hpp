// How far a map's occupied cells lie from the true walls and the walls from the cells:
// cloud-to-cloud distances through Open3D, and the clouds as PLY. It does not register the clouds:
// the map is laid into the world by the trajectory's first poses, so that a map that shrank or bent
// is charged for it.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "datasets/simulation/world.hpp"
#include "slam/core/grid_map.hpp"
#include "slam/core/pose2.hpp"
#include "slam/core/result.hpp"
#include "slam/core/trajectory.hpp"

namespace corridor::metrics {

using PlanarCloud = std::vector<Eigen::Vector2d>;

// Centres of the cells with occupancy probability above 0.5, laid into the world.
PlanarCloud occupied_points_world(const GridMap& map, const Pose2& T_world_map);

struct CloudDistances {
  // Mean of the two directed mean nearest-neighbour distances, (mean_a min_b |a-b| + mean_b min_a
  // |a-b|) / 2.
  double chamfer_m = 0;
  // The larger of the two directed 95th percentiles (nearest rank) of nearest-neighbour distances.
  double hausdorff95_m = 0;
};

// nullopt if one of the clouds is empty.
std::optional<CloudDistances> cloud_distances(const PlanarCloud& a, const PlanarCloud& b);

// The map's cloud against points every 5 cm on the walls that were visible within lidar_range_m
// from a matched true pose. T_world_map is the origin alignment. nullopt for an empty map or no
// matched poses.
std::optional<CloudDistances> score_map_cloud(const GridMap& map, const Trajectory& estimate,
                                              const Trajectory& truth_world,
                                              const simulation::World& world, double lidar_range_m);

// Binary PLY, z = 0. An Error for an empty cloud and for a file that cannot be written.
Result<void> write_ply(const PlanarCloud& cloud, const std::filesystem::path& path);

}  // namespace corridor::metrics
