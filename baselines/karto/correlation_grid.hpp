// The look-up grid of correlative matching: end points of a local map, smeared, one byte a cell.
// [Konolige2010] section IV; [Olson2009] section III. It moves with the search: its centre is the
// predicted pose. It keeps no free space.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "baselines/karto/smear_kernel.hpp"
#include "baselines/karto/valid_points.hpp"

namespace corridor::karto {

struct GridSpec {
  double resolution_m = 0.01;
  double window_m = 0.3;  // side of the search window
  double reach_m = 12;    // longest beam
  double smear_m = 0.03;  // standard deviation of an end point

  // Cells that may hold an end point: round(window / resolution) + 1 + 2 * ceil(reach /
  // resolution).
  [[nodiscard]] int inner_side_cells() const;
};

// Cells are addressed by linear index = column + row * stride(), and only the linear index is
// range-checked by those who look up, as in the original: stride() is the side padded to 8. A
// border of the kernel's half width + 1 around the inner cells takes the smear.
class CorrelationGrid {
 public:
  explicit CorrelationGrid(const GridSpec& spec);

  // Empties the grid and moves its middle cell's centre to a point of the map.
  void reset(const Eigen::Vector2d& centre_map_m);
  // The linear index of each point's cell, kOutside for those beyond the inner cells.
  void find_cells(const PointColumns& points_map_m, std::vector<std::int32_t>& indices) const;
  static constexpr std::int32_t kOutside = -1;
  // Sets each of these cells to kOccupied and stamps the kernel around it with max().
  void occupy(std::span<const std::int32_t> indices);

  [[nodiscard]] int side_cells() const { return side_; }
  [[nodiscard]] int stride() const { return stride_; }
  [[nodiscard]] std::int32_t num_cells() const { return side_ * stride_; }
  [[nodiscard]] double resolution_m() const { return resolution_m_; }

  // Nearest cell (column, row); may lie outside.
  [[nodiscard]] Eigen::Vector2i cell_of(const Eigen::Vector2d& point_map_m) const;
  [[nodiscard]] std::int32_t linear_index(const Eigen::Vector2i& cell) const {
    return cell.x() + cell.y() * stride_;
  }
  // At least kMargin readable bytes lie on either side of [0, num_cells()).
  [[nodiscard]] const std::uint8_t* cells() const { return bytes_.data() + kMargin; }
  static constexpr int kMargin = 64;

 private:
  // What a reset erases at once: the stamps around all cells of one block.
  static constexpr int kBlockShift_rows = 5;
  static constexpr int kBlockShift_columns = 6;

  void stamp(std::int32_t centre_index);
  void remember_block(std::int32_t centre_index);
  void erase_block(std::int32_t block);

  double resolution_m_;
  SmearKernel kernel_;
  int border_;
  int side_;
  int stride_;
  Eigen::Vector2d corner_map_m_ = Eigen::Vector2d::Zero();  // centre of cell (0, 0)
  std::vector<std::uint8_t> bytes_;
  int blocks_per_row_;
  std::vector<std::uint8_t> is_drawn_;  // by block: it has occupied cells
  std::vector<std::int32_t> drawn_blocks_;
};

}  // namespace corridor::karto
