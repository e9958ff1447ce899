// Scans of simple rooms made of wall segments, cast by a few lines that share no code with the
// simulator.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "slam/core/pose2.hpp"
#include "slam/core/rng.hpp"
#include "slam/core/scan.hpp"

namespace corridor::testing {

using Wall = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

// A 9 x 6 m room with a corner cut out: every direction is seen from inside.
inline std::vector<Wall> room() {
  const std::vector<Eigen::Vector2d> corners = {{-4, -3}, {5, -3}, {5, 1}, {3, 1}, {3, 3}, {-4, 3}};
  std::vector<Wall> walls;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    walls.emplace_back(corners[i], corners[(i + 1) % corners.size()]);
  }
  return walls;
}

// Two parallel walls along x, far longer than any range used.
inline std::vector<Wall> corridor_walls() {
  return {{{-100, -1.3}, {100, -1.3}}, {{-100, 1.7}, {100, 1.7}}};
}

inline double cast(const std::vector<Wall>& walls, const Eigen::Vector2d& from, double angle_rad) {
  const Eigen::Vector2d d(std::cos(angle_rad), std::sin(angle_rad));
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : walls) {
    const Eigen::Vector2d e = b - a;
    const double denominator = d.x() * e.y() - d.y() * e.x();
    if (denominator == 0) continue;
    const Eigen::Vector2d w = a - from;
    const double t = (w.x() * e.y() - w.y() * e.x()) / denominator;
    const double s = (w.x() * d.y() - w.y() * d.x()) / denominator;
    if (t > 0 && s >= 0 && s <= 1 && t < nearest) nearest = t;
  }
  return nearest;
}

// 360 beams around, Gaussian range noise; beams past the range are invalid and read range + 1.
inline LaserScan scan_of(const std::vector<Wall>& walls, const Pose2& T_map_base, double range_m,
                         double sigma_m, Rng& rng, Timestamp stamp = {}) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.range_max_m = range_m;
  scan.angle_increment_rad = 2 * std::numbers::pi / 360;
  scan.angle_min_rad = -std::numbers::pi + scan.angle_increment_rad / 2;
  for (std::size_t i = 0; i < 360; ++i) {
    const double exact = cast(walls, T_map_base.translation_m(),
                              T_map_base.theta_rad() + scan.angle_min_rad +
                                  static_cast<double>(i) * scan.angle_increment_rad);
    const double measured = exact + rng.normal(0, sigma_m);
    const bool is_valid = exact < range_m && measured > 0 && measured <= range_m;
    scan.ranges_m.push_back(static_cast<float>(is_valid ? measured : range_m + 1));
    scan.is_valid.push_back(is_valid ? 1 : 0);
  }
  return scan;
}

inline std::vector<Eigen::Vector2d> points_of(const LaserScan& scan) {
  std::vector<Eigen::Vector2d> points_base;
  for (std::size_t i = 0; i < scan.num_beams(); ++i) {
    if (scan.is_valid[i]) points_base.push_back(scan.point_base_m(i));
  }
  return points_base;
}

inline std::vector<Eigen::Vector2d> moved(const Pose2& T, std::vector<Eigen::Vector2d> points) {
  for (Eigen::Vector2d& p : points) p = T * p;
  return points;
}

}  // namespace corridor::testing
