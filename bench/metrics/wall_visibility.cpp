#include "bench/metrics/wall_visibility.hpp"

#include <cmath>

#include "datasets/simulation/ray_casting.hpp"

namespace corridor::metrics {
namespace {

// A ray that ends this near to the point ended at the point: far above rounding, far below a cell.
constexpr double kSamePoint_m = 1e-6;

bool is_visible(const simulation::RayCaster& caster, const Eigen::Vector2d& from_m,
                const Eigen::Vector2d& point_m, double range_m) {
  const Eigen::Vector2d ray_m = point_m - from_m;
  const double distance_m = ray_m.norm();
  if (!(distance_m <= range_m)) return false;
  const auto hit_range_m =
      caster.range_m(from_m, std::atan2(ray_m.y(), ray_m.x()), distance_m + kSamePoint_m);
  // No hit at all: the ray runs along the point's own wall.
  return hit_range_m && *hit_range_m >= distance_m - kSamePoint_m;
}

}  // namespace

std::vector<WallPoint> sample_walls(const simulation::World& world, double spacing_m) {
  std::vector<WallPoint> points;
  const auto append = [&](double length_m, const auto& point_at) {
    const auto num_pieces = static_cast<int>(std::ceil(length_m / spacing_m));
    for (int i = 0; i < num_pieces; ++i) points.push_back(point_at((i + 0.5) / num_pieces));
  };
  for (std::size_t i = 0; i < world.walls.size(); ++i) {
    const simulation::Segment& wall = world.walls[i];
    append(wall.length_m(), [&](double ratio) {
      return WallPoint{wall.a_m + ratio * (wall.b_m - wall.a_m), i};
    });
  }
  for (std::size_t i = 0; i < world.arcs.size(); ++i) {
    const simulation::Arc& arc = world.arcs[i];
    append(arc.length_m(), [&](double ratio) {
      return WallPoint{arc.point_m(ratio), world.walls.size() + i};
    });
  }
  return points;
}

std::vector<std::vector<std::uint32_t>> find_sightings(std::span<const WallPoint> points,
                                                       const simulation::World& world,
                                                       std::span<const Pose2> T_world_base,
                                                       double range_m) {
  const simulation::RayCaster caster(world);
  std::vector<std::vector<std::uint32_t>> sightings(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (std::size_t i = 0; i < T_world_base.size(); ++i) {
      if (is_visible(caster, T_world_base[i].translation_m(), points[k].point_world_m, range_m)) {
        sightings[k].push_back(static_cast<std::uint32_t>(i));
      }
    }
  }
  return sightings;
}

}  // namespace corridor::metrics
