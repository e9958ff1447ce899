#include "slam/core/grid_map.hpp"

#include <cmath>

#include "slam/core/expect.hpp"

namespace corridor {

GridMap::GridMap(double resolution_m, Eigen::Vector2d origin_m, int num_columns, int num_rows)
    : resolution_m_(resolution_m),
      origin_m_(std::move(origin_m)),
      num_columns_(num_columns),
      num_rows_(num_rows) {
  CORRIDOR_EXPECT(resolution_m > 0);
  CORRIDOR_EXPECT(num_columns >= 0 && num_rows >= 0);
  cells_.resize(static_cast<std::size_t>(num_columns) * static_cast<std::size_t>(num_rows));
}

Eigen::Vector2i GridMap::cell_of(const Eigen::Vector2d& point_map_m) const {
  const Eigen::Vector2d cell = (point_map_m - origin_m_) / resolution_m_;
  return {static_cast<int>(std::floor(cell.x())), static_cast<int>(std::floor(cell.y()))};
}

Eigen::Vector2d GridMap::centre_m(int column, int row) const {
  return origin_m_ + resolution_m_ * Eigen::Vector2d(column + 0.5, row + 0.5);
}

double probability_from_log_odds(double log_odds) { return 1 / (1 + std::exp(-log_odds)); }

double log_odds_from_probability(double probability) {
  CORRIDOR_EXPECT(probability > 0 && probability < 1);
  return std::log(probability / (1 - probability));
}

}  // namespace corridor
