// A local map of surfaces: a grid whose cells keep the moments of the scan points in them, pooled
// over 3 x 3 cells into one Gaussian with a normal (normal distributions transform [Biber2003],
// used point-to-line as in [Censi2008]). Sub-cell exact: a wall lies where its points' mean lies.
// It does not model free space and never forgets a point.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

namespace corridor::matching {

// The surface near a place, in the grid's frame.
struct Surfel {
  Eigen::Vector2d mean_m;
  Eigen::Vector2d normal;      // unit; direction of the smaller spread
  double normal_variance_m2;   // spread along the normal
  double tangent_variance_m2;  // spread along the surface
  double num_points;
};

class SurfelGrid {
 public:
  // resolution_m > 0: side of a cell; a surfel pools a window of three cells.
  explicit SurfelGrid(double resolution_m);
  SurfelGrid(SurfelGrid&&) noexcept;
  SurfelGrid& operator=(SurfelGrid&&) noexcept;
  ~SurfelGrid();

  void insert(std::span<const Eigen::Vector2d> points_m);
  // Surfel of the window around the cell that covers the point; nullptr where fewer than three
  // points lie. The pointer is valid until the next insert(). Pools lazily, so not for concurrent
  // use.
  [[nodiscard]] const Surfel* find(const Eigen::Vector2d& point_m);
  // Mean point of every occupied cell, in a fixed order (row by row of tiles).
  [[nodiscard]] std::vector<Eigen::Vector2d> cell_means_m() const;

  [[nodiscard]] double resolution_m() const { return resolution_m_; }

 private:
  static constexpr int kTileSide = 8;  // cells; 2^3
  struct Cell;
  struct Tile;

  [[nodiscard]] Tile* tile_at(int tile_x, int tile_y) const;
  [[nodiscard]] const Cell* cell_at(int x, int y) const;
  void pool(int x, int y, Cell& cell) const;

  double resolution_m_;
  std::unordered_map<std::int64_t, std::unique_ptr<Tile>> tiles_;
};

}  // namespace corridor::matching
