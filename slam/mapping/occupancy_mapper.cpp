#include "slam/mapping/occupancy_mapper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace corridor::mapping {
namespace {

struct Extent {
  Eigen::Vector2d min = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d max = -min;

  void include(const Eigen::Vector2d& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
};

// One beam: from the sensor to its end, in the map frame.
struct Beam {
  Eigen::Vector2d from_m, to_m;
  bool is_hit;
};

template <class Visitor>
void for_each_beam(const PosedScan& posed, bool use_no_returns, Visitor&& visit) {
  const LaserScan& scan = *posed.scan;
  const bool is_swept = scan.duration_s != 0 && !posed.twist_base.isZero();
  Eigen::Vector2d sensor = posed.T_map_base * scan.T_base_lidar.translation_m();
  Pose2 T_map_lidar = posed.T_map_base * scan.T_base_lidar;
  for (std::size_t i = 0; i < scan.num_beams(); ++i) {
    const bool is_hit = scan.is_valid[i] != 0;
    if (!is_hit && !use_no_returns) continue;
    if (is_swept) {
      const Pose2 T_map_base =
          posed.T_map_base * Pose2::exp(posed.twist_base * scan.beam_time_s(i));
      sensor = T_map_base * scan.T_base_lidar.translation_m();
      T_map_lidar = T_map_base * scan.T_base_lidar;
    }
    const double range_m = is_hit ? static_cast<double>(scan.ranges_m[i]) : scan.range_max_m;
    const double angle = scan.angle_rad(i);
    const Eigen::Vector2d end =
        T_map_lidar * Eigen::Vector2d(range_m * std::cos(angle), range_m * std::sin(angle));
    visit(Beam{sensor, end, is_hit});
  }
}

// Visits every cell a segment passes, the end cell excluded [Amanatides1987].
template <class Visitor>
void traverse(const GridMap& map, const Beam& beam, Visitor&& visit) {
  const Eigen::Vector2d from = (beam.from_m - map.origin_m()) / map.resolution_m();
  const Eigen::Vector2d to = (beam.to_m - map.origin_m()) / map.resolution_m();
  const Eigen::Vector2d direction = to - from;
  Eigen::Vector2i cell = map.cell_of(beam.from_m);
  const Eigen::Vector2i last = map.cell_of(beam.to_m);
  Eigen::Vector2i step;
  Eigen::Vector2d t_next, t_step;
  for (int k = 0; k < 2; ++k) {
    step[k] = direction[k] > 0 ? 1 : -1;
    const double length = std::abs(direction[k]);
    t_step[k] = length > 0 ? 1 / length : std::numeric_limits<double>::infinity();
    const double to_border = direction[k] > 0 ? cell[k] + 1 - from[k] : from[k] - cell[k];
    t_next[k] = length > 0 ? to_border / length : std::numeric_limits<double>::infinity();
  }
  const int num_cells = (last - cell).cwiseAbs().sum();
  for (int i = 0; i < num_cells; ++i) {
    visit(cell);
    const int k = t_next[0] < t_next[1] ? 0 : 1;
    cell[k] += step[k];
    t_next[k] += t_step[k];
  }
}

}  // namespace

GridMap build_occupancy_map(std::span<const PosedScan> scans, const OccupancyMapperParams& params) {
  Extent extent;
  for (const PosedScan& posed : scans) {
    for_each_beam(posed, params.use_no_returns, [&](const Beam& beam) {
      extent.include(beam.from_m);
      extent.include(beam.to_m);
    });
  }
  if (!(extent.min.x() <= extent.max.x())) return {};
  const double r = params.resolution_m;
  // The grid's lines lie on multiples of the resolution, so that maps of one frame can be compared.
  const Eigen::Vector2d origin = ((extent.min / r).array().floor() - 1).matrix() * r;
  const Eigen::Vector2d size = ((extent.max - origin) / r).array().ceil() + 1;
  GridMap map(r, origin, static_cast<int>(size.x()), static_cast<int>(size.y()));
  const auto limit = static_cast<float>(params.max_abs_log_odds);
  const auto add = [&](const Eigen::Vector2i& cell, double log_odds) -> GridCell& {
    GridCell& c = map.at(cell.x(), cell.y());
    c.log_odds = std::clamp(c.log_odds + static_cast<float>(log_odds), -limit, limit);
    c.is_observed = true;
    return c;
  };
  for (const PosedScan& posed : scans) {
    for_each_beam(posed, params.use_no_returns, [&](const Beam& beam) {
      traverse(map, beam, [&](const Eigen::Vector2i& cell) { add(cell, params.miss_log_odds); });
      if (beam.is_hit) add(map.cell_of(beam.to_m), params.hit_log_odds).hits += 1;
    });
  }
  return map;
}

}  // namespace corridor::mapping
