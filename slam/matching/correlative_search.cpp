#include "slam/matching/correlative_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace corridor::matching {
namespace {

std::vector<Eigen::Vector2i> cells_of(std::span<const Eigen::Vector2d> points_base,
                                      const Pose2& T_map_base, const SurfaceImage& image) {
  std::vector<Eigen::Vector2i> cells;
  cells.reserve(points_base.size());
  const Eigen::Matrix2d R = T_map_base.rotation();
  for (const Eigen::Vector2d& p : points_base) {
    const Eigen::Vector2d q =
        (R * p + T_map_base.translation_m() - image.origin_m()) / image.resolution_m();
    cells.emplace_back(static_cast<int>(std::floor(q.x())), static_cast<int>(std::floor(q.y())));
  }
  return cells;
}

int score_at(const SurfaceImage& image, const std::vector<Eigen::Vector2i>& cells, int dx, int dy) {
  int sum = 0;
  for (const Eigen::Vector2i& cell : cells) sum += image.at(cell.x() + dx, cell.y() + dy);
  return sum;
}

}  // namespace

SurfaceImage::SurfaceImage(std::span<const Eigen::Vector2d> surface_points_m,
                           const CorrelativeParams& params)
    : resolution_m_(params.resolution_m) {
  if (surface_points_m.empty()) return;
  Eigen::Vector2d low = surface_points_m.front();
  Eigen::Vector2d high = low;
  for (const Eigen::Vector2d& p : surface_points_m) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const int reach = static_cast<int>(std::ceil(2 * params.smear_m / resolution_m_));
  origin_m_ = low - Eigen::Vector2d::Constant((reach + 1) * resolution_m_);
  num_columns_ = static_cast<int>((high.x() - origin_m_.x()) / resolution_m_) + reach + 2;
  num_rows_ = static_cast<int>((high.y() - origin_m_.y()) / resolution_m_) + reach + 2;
  cells_.assign(static_cast<std::size_t>(num_columns_) * static_cast<std::size_t>(num_rows_), 0);
  const double inverse = 1 / (2 * params.smear_m * params.smear_m);
  for (const Eigen::Vector2d& p : surface_points_m) {
    const Eigen::Vector2d q = (p - origin_m_) / resolution_m_;
    const int column = static_cast<int>(q.x());
    const int row = static_cast<int>(q.y());
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const double ex = (column + dx + 0.5 - q.x()) * resolution_m_;
        const double ey = (row + dy + 0.5 - q.y()) * resolution_m_;
        const auto value =
            static_cast<std::uint8_t>(255 * std::exp(-(ex * ex + ey * ey) * inverse));
        auto& cell =
            cells_[static_cast<std::size_t>(row + dy) * static_cast<std::size_t>(num_columns_) +
                   static_cast<std::size_t>(column + dx)];
        cell = std::max(cell, value);
      }
    }
  }
}

CorrelativeResult search(const SurfaceImage& image, std::span<const Eigen::Vector2d> points_base_m,
                         const Pose2& T_map_base_centre, double window_m, double window_rad,
                         const CorrelativeParams& params) {
  CorrelativeResult best{T_map_base_centre, 0};
  if (points_base_m.empty()) return best;
  const int reach = static_cast<int>(std::ceil(window_m / image.resolution_m()));
  const int num_angles = static_cast<int>(std::ceil(window_rad / params.angle_step_rad));
  int best_sum = -1;
  double best_distance2 = std::numeric_limits<double>::infinity();
  for (int a = -num_angles; a <= num_angles; ++a) {
    const double turn = a * params.angle_step_rad;
    const Pose2 rotated(T_map_base_centre.x_m(), T_map_base_centre.y_m(),
                        T_map_base_centre.theta_rad() + turn);
    const std::vector<Eigen::Vector2i> cells = cells_of(points_base_m, rotated, image);
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const int sum = score_at(image, cells, dx, dy);
        const double x = dx * image.resolution_m();
        const double y = dy * image.resolution_m();
        const double distance2 = x * x + y * y + turn * turn;
        if (sum < best_sum || (sum == best_sum && distance2 >= best_distance2)) continue;
        best_sum = sum;
        best_distance2 = distance2;
        best.T_map_base = Pose2(rotated.x_m() + x, rotated.y_m() + y, rotated.theta_rad());
      }
    }
  }
  best.score = best_sum / (255.0 * static_cast<double>(points_base_m.size()));
  return best;
}

}  // namespace corridor::matching
