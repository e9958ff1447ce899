#include "baselines/karto/occupancy_rule.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace corridor::karto {
namespace {

constexpr double kMaxAbsLogOdds = 5.0;

struct Ray {
  Eigen::Vector2d from_m;
  Eigen::Vector2d to_m;
  bool is_hit;
};

std::vector<Ray> rays_of(const KeyScan& scan, const Pose2& T_frame_map, double range_threshold_m) {
  const Pose2 T_frame_sensor = T_frame_map * scan.T_map_sensor();
  const Eigen::Matrix2d R_frame_sensor = T_frame_sensor.rotation();
  const Eigen::Vector2d from_m = T_frame_sensor.translation_m();
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < scan.beams_sensor_m().size(); ++i) {
    if (!scan.is_return()[i]) continue;
    const Eigen::Vector2d beam_m = R_frame_sensor * scan.beams_sensor_m()[i];
    if (scan.is_in_range()[i]) {
      rays.push_back({from_m, from_m + beam_m, true});
    } else {
      rays.push_back({from_m, from_m + range_threshold_m * beam_m.normalized(), false});
    }
  }
  return rays;
}

// Passes and hits of every cell.
class PassCounter {
 public:
  PassCounter(double resolution_m, const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m)
      : map_(resolution_m, min_m - Eigen::Vector2d::Constant(resolution_m),
             static_cast<int>((max_m.x() - min_m.x()) / resolution_m) + 3,
             static_cast<int>((max_m.y() - min_m.y()) / resolution_m) + 3),
        passes_(static_cast<std::size_t>(map_.num_columns()) *
                    static_cast<std::size_t>(map_.num_rows()),
                0) {}

  // Bresenham's line from cell to cell, both ends included.
  void trace(const Ray& ray) {
    Eigen::Vector2i cell = map_.cell_of(ray.from_m);
    const Eigen::Vector2i last = map_.cell_of(ray.to_m);
    const int dx = std::abs(last.x() - cell.x());
    const int dy = -std::abs(last.y() - cell.y());
    const int step_x = cell.x() < last.x() ? 1 : -1;
    const int step_y = cell.y() < last.y() ? 1 : -1;
    int error = dx + dy;
    while (true) {
      ++passes(cell);
      if (cell == last) break;
      const int doubled = 2 * error;
      if (doubled >= dy) {
        error += dy;
        cell.x() += step_x;
      }
      if (doubled <= dx) {
        error += dx;
        cell.y() += step_y;
      }
    }
    if (ray.is_hit) map_.at(last.x(), last.y()).hits += 1;
  }

  GridMap decide(int min_passes, double threshold) && {
    for (int row = 0; row < map_.num_rows(); ++row) {
      for (int column = 0; column < map_.num_columns(); ++column) {
        const int num_passes = passes({column, row});
        if (num_passes <= min_passes) continue;
        GridCell& cell = map_.at(column, row);
        cell.is_observed = true;
        cell.log_odds = log_odds_of(static_cast<double>(cell.hits) / num_passes, threshold);
      }
    }
    return std::move(map_);
  }

 private:
  static float log_odds_of(double share, double threshold) {
    const double log_odds =
        std::log(share / (1 - share)) - log_odds_from_probability(threshold);  // +-inf at 0 and 1
    return static_cast<float>(std::clamp(log_odds, -kMaxAbsLogOdds, kMaxAbsLogOdds));
  }

  int& passes(const Eigen::Vector2i& cell) {
    return passes_[static_cast<std::size_t>(cell.y()) *
                       static_cast<std::size_t>(map_.num_columns()) +
                   static_cast<std::size_t>(cell.x())];
  }

  GridMap map_;
  std::vector<int> passes_;
};

}  // namespace

GridMap build_karto_map(std::span<const KeyScan> scans, const Pose2& T_frame_map,
                        double range_threshold_m, const KartoParams& params) {
  std::vector<Ray> rays;
  for (const KeyScan& scan : scans) {
    const std::vector<Ray> of_scan = rays_of(scan, T_frame_map, range_threshold_m);
    rays.insert(rays.end(), of_scan.begin(), of_scan.end());
  }
  if (rays.empty()) return {};
  Eigen::Vector2d min_m = rays.front().from_m;
  Eigen::Vector2d max_m = min_m;
  for (const Ray& ray : rays) {
    min_m = min_m.cwiseMin(ray.from_m).cwiseMin(ray.to_m);
    max_m = max_m.cwiseMax(ray.from_m).cwiseMax(ray.to_m);
  }
  PassCounter counter(params.map_resolution_m, min_m, max_m);
  for (const Ray& ray : rays) counter.trace(ray);
  return std::move(counter).decide(params.map_min_passes, params.map_occupancy_threshold);
}

}  // namespace corridor::karto
