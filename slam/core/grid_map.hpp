// An occupancy grid: the map every system hands in.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace corridor {

// What one cell knows.
struct GridCell {
  float log_odds = 0;  // ln(p / (1 - p)) of being occupied; 0 = as likely as not
  float hits = 0;  // number (or weight) of beam end points in the cell; 0 if the mapper keeps none
  bool is_observed = false;

  bool operator==(const GridCell&) const = default;
};

// Cell (column, row) covers the square from origin_m + resolution_m * (column, row) to the next
// corner; columns run along +x, rows along +y of the map frame. Row-major storage.
class GridMap {
 public:
  GridMap() = default;
  // Requires resolution_m > 0 and num_columns, num_rows >= 0.
  GridMap(double resolution_m, Eigen::Vector2d origin_m, int num_columns, int num_rows);

  [[nodiscard]] double resolution_m() const { return resolution_m_; }
  // Lower left corner of cell (0, 0) in the map frame.
  [[nodiscard]] const Eigen::Vector2d& origin_m() const { return origin_m_; }
  [[nodiscard]] int num_columns() const { return num_columns_; }
  [[nodiscard]] int num_rows() const { return num_rows_; }
  [[nodiscard]] bool empty() const { return cells_.empty(); }

  [[nodiscard]] bool contains(int column, int row) const {
    return column >= 0 && row >= 0 && column < num_columns_ && row < num_rows_;
  }
  // Requires contains(column, row).
  [[nodiscard]] GridCell& at(int column, int row) { return cells_[index(column, row)]; }
  [[nodiscard]] const GridCell& at(int column, int row) const { return cells_[index(column, row)]; }

  // (column, row) of the cell that covers a point of the map frame; may lie outside.
  [[nodiscard]] Eigen::Vector2i cell_of(const Eigen::Vector2d& point_map_m) const;
  [[nodiscard]] Eigen::Vector2d centre_m(int column, int row) const;

  bool operator==(const GridMap&) const = default;

 private:
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(num_columns_) +
           static_cast<std::size_t>(column);
  }

  double resolution_m_ = 0.05;
  Eigen::Vector2d origin_m_ = Eigen::Vector2d::Zero();
  int num_columns_ = 0;
  int num_rows_ = 0;
  std::vector<GridCell> cells_;
};

double probability_from_log_odds(double log_odds);
// Requires 0 < probability < 1.
double log_odds_from_probability(double probability);

}  // namespace corridor
