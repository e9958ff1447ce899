#include "baselines/gmapping/published_map.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "slam/core/expect.hpp"

namespace corridor::gmapping {
namespace {

struct Extent {
  Eigen::Vector2d low_m;
  Eigen::Vector2d high_m;

  void include(const Eigen::Vector2d& point_m) {
    low_m = low_m.cwiseMin(point_m);
    high_m = high_m.cwiseMax(point_m);
  }
};

Eigen::Vector2d point_map_m(const ScanPoints& points, std::size_t index, const Pose2& T_map_base) {
  return T_map_base * Eigen::Vector2d(points.x_base_m[index], points.y_base_m[index]);
}

// The grid covers all end points and LiDAR positions; its cells are those of the particles' maps.
GridMap empty_map(std::span<const UsedScan> scans, std::span<const Pose2> path_map_base,
                  double cell_size_m) {
  const Eigen::Vector2d start_m = (path_map_base[0] * scans[0].T_base_lidar).translation_m();
  Extent extent{start_m, start_m};
  for (std::size_t i = 0; i < scans.size(); ++i) {
    extent.include((path_map_base[i] * scans[i].T_base_lidar).translation_m());
    for (std::size_t k = 0; k < scans[i].points.size(); ++k) {
      extent.include(point_map_m(scans[i].points, k, path_map_base[i]));
    }
  }
  const Eigen::Array2d low_cell = (extent.low_m / cell_size_m).array().floor();
  const Eigen::Array2d high_cell = (extent.high_m / cell_size_m).array().floor();
  // One spare cell on each side keeps points on a cell border inside.
  return GridMap(cell_size_m, (low_cell - 1) * cell_size_m,
                 static_cast<int>(high_cell.x() - low_cell.x()) + 3,
                 static_cast<int>(high_cell.y() - low_cell.y()) + 3);
}

// Calls visit(column, row) for the cells of a Bresenham line, both ends included.
template <class Visit>
void trace_line(const Eigen::Vector2i& from, const Eigen::Vector2i& to, Visit&& visit) {
  const int dx = std::abs(to.x() - from.x());
  const int dy = -std::abs(to.y() - from.y());
  const int step_x = from.x() < to.x() ? 1 : -1;
  const int step_y = from.y() < to.y() ? 1 : -1;
  int error = dx + dy;
  for (int x = from.x(), y = from.y();;) {
    visit(x, y);
    if (x == to.x() && y == to.y()) return;
    const int doubled = 2 * error;
    if (doubled >= dy) {
      error += dy;
      x += step_x;
    }
    if (doubled <= dx) {
      error += dx;
      y += step_y;
    }
  }
}

void count_scan(const UsedScan& scan, const Pose2& T_map_base, GridMap& map,
                std::vector<std::uint32_t>& visits) {
  const Eigen::Vector2i lidar_cell = map.cell_of((T_map_base * scan.T_base_lidar).translation_m());
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    const Eigen::Vector2i end_cell = map.cell_of(point_map_m(scan.points, k, T_map_base));
    trace_line(lidar_cell, end_cell, [&](int column, int row) {
      ++visits[static_cast<std::size_t>(row) * static_cast<std::size_t>(map.num_columns()) +
               static_cast<std::size_t>(column)];
    });
    map.at(end_cell.x(), end_cell.y()).hits += 1;
  }
}

float log_odds_of(double hits, double visits, double occupied_ratio) {
  const double threshold = log_odds_from_probability(occupied_ratio);
  const double ratio = hits / visits;
  if (ratio <= 0) return static_cast<float>(-kMaxAbsLogOdds);
  if (ratio >= 1) return static_cast<float>(kMaxAbsLogOdds);
  return static_cast<float>(
      std::clamp(log_odds_from_probability(ratio) - threshold, -kMaxAbsLogOdds, kMaxAbsLogOdds));
}

}  // namespace

GridMap published_map(std::span<const UsedScan> scans, std::span<const Pose2> path_map_base,
                      const GmappingParams& params) {
  CORRIDOR_EXPECT(scans.size() == path_map_base.size());
  const bool has_points = std::any_of(scans.begin(), scans.end(),
                                      [](const UsedScan& scan) { return scan.points.size() > 0; });
  if (!has_points) return {};
  GridMap map = empty_map(scans, path_map_base, params.cell_size_m);
  std::vector<std::uint32_t> visits(static_cast<std::size_t>(map.num_columns()) *
                                    static_cast<std::size_t>(map.num_rows()));
  for (std::size_t i = 0; i < scans.size(); ++i) {
    count_scan(scans[i], path_map_base[i], map, visits);
  }
  std::size_t index = 0;
  for (int row = 0; row < map.num_rows(); ++row) {
    for (int column = 0; column < map.num_columns(); ++column, ++index) {
      if (visits[index] == 0) continue;
      GridCell& cell = map.at(column, row);
      cell.is_observed = true;
      cell.log_odds = log_odds_of(cell.hits, visits[index], params.map_occupied_ratio);
    }
  }
  return map;
}

}  // namespace corridor::gmapping
