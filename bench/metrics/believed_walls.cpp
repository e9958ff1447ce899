#include "bench/metrics/believed_walls.hpp"

#include "bench/metrics/wall_visibility.hpp"
#include "bench/statistics/quantiles.hpp"
#include "slam/core/pose2.hpp"

namespace corridor::metrics {
namespace {

constexpr double kPointSpacing_m = 0.1;
constexpr double kLowPercent = 16;  // of a normal distribution lie below -1 sigma
constexpr double kHighPercent = 84;

// Positions of points along a unit vector.
std::vector<double> project(const std::vector<Eigen::Vector2d>& points_m,
                            const Eigen::Vector2d& direction) {
  std::vector<double> positions_m;
  positions_m.reserve(points_m.size());
  for (const auto& point_m : points_m) positions_m.push_back(direction.dot(point_m));
  return positions_m;
}

double half_spread(const std::vector<double>& values) {
  const auto low = statistics::percentile(values, kLowPercent);
  const auto high = statistics::percentile(values, kHighPercent);
  return low && high ? (*high - *low) / 2 : 0;
}

Eigen::Vector2d median_point_m(const std::vector<Eigen::Vector2d>& points_m) {
  return {statistics::median(project(points_m, {1, 0})).value_or(0),
          statistics::median(project(points_m, {0, 1})).value_or(0)};
}

}  // namespace

std::vector<BelievedPoint> believe_walls(std::span<const MatchedPose> pairs,
                                         const simulation::World& world, double lidar_range_m) {
  std::vector<Pose2> T_world_base, T_map_world;
  for (const MatchedPose& pair : pairs) {
    T_world_base.push_back(pair.T_world_base);
    T_map_world.push_back(pair.T_map_base * pair.T_world_base.inverse());
  }
  const auto samples = sample_walls(world, kPointSpacing_m);
  const auto sightings = find_sightings(samples, world, T_world_base, lidar_range_m);
  std::vector<BelievedPoint> points;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (sightings[k].empty()) continue;
    std::vector<Eigen::Vector2d> believed_m;
    for (const std::uint32_t i : sightings[k]) {
      believed_m.push_back(T_map_world[i] * samples[k].point_world_m);
    }
    // Across the wall as the middle sighting turned it.
    const Eigen::Vector2d across_map =
        T_map_world[sightings[k][sightings[k].size() / 2]].rotation() *
        world.normal(samples[k].surface_index, samples[k].point_world_m);
    points.push_back({samples[k].point_world_m, median_point_m(believed_m),
                      half_spread(project(believed_m, across_map))});
  }
  return points;
}

}  // namespace corridor::metrics
