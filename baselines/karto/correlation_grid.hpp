// The look-up grid of correlative matching: end points of a local map, smeared, one byte a cell.
// [Konolige2010] section IV; [Olson2009] section III. It moves with the search: its centre is the
// predicted pose. It keeps no free space.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "baselines/karto/grid_blocks.hpp"
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

// Cells of many points.
struct GridCells {
  std::vector<std::int32_t> index;  // linear
  std::vector<std::int32_t> block;  // GridBlocks::kNowhere for a point outside the inner cells

  void resize(std::size_t count) {
    index.resize(count);
    block.resize(count);
  }
};

// Cells are addressed by linear index = column + row * stride(), and only the linear index is
// range-checked by those who look up, as in the original: stride() is the side padded to 8. A
// border of the kernel's half width + 1 around the inner cells takes the smear.
// Only what a search may read is drawn: between reset() and occupy() the search says around which
// cells it is going to read.
class CorrelationGrid {
 public:
  // A search reads at most `read_margin_cells` away, along rows and columns, from what it wants.
  CorrelationGrid(const GridSpec& spec, int read_margin_cells);

  // Empties the grid, moves its middle cell's centre to a point of the map, and wants nothing.
  void reset(const Eigen::Vector2d& centre_map_m);
  [[nodiscard]] GridBlocks& blocks() { return blocks_; }
  [[nodiscard]] const GridBlocks& blocks() const { return blocks_; }
  // True if a stamp sets its neighbours to kOccupied as well. Which of them are then stamped
  // themselves depends on the order of all points, so that none may be left out.
  [[nodiscard]] bool needs_all_points() const { return kernel_.at(1, 0) == kOccupied; }
  void find_cells(const PointColumns& points_map_m, GridCells& cells) const;
  // Sets the first `count` of them, if wanted, to kOccupied and stamps the kernel around each with
  // max().
  void occupy(const GridCells& cells, std::size_t count);

  [[nodiscard]] int side_cells() const { return side_; }
  [[nodiscard]] int stride() const { return stride_; }
  [[nodiscard]] std::int32_t num_cells() const { return side_ * stride_; }
  [[nodiscard]] double resolution_m() const { return resolution_m_; }
  // How far the smear of an end point reaches from its cell.
  [[nodiscard]] int smear_reach_cells() const { return kernel_.half_width; }

  [[nodiscard]] int middle_cell() const { return (side_ - 1) / 2; }  // column and row
  // Nearest cell (column, row); may lie outside.
  [[nodiscard]] Eigen::Vector2i cell_of(const Eigen::Vector2d& point_map_m) const;
  [[nodiscard]] std::int32_t linear_index(const Eigen::Vector2i& cell) const {
    return cell.x() + cell.y() * stride_;
  }
  // At least kMargin readable bytes lie on either side of [0, num_cells()).
  [[nodiscard]] const std::uint8_t* cells() const { return bytes_.data() + kMargin; }
  static constexpr int kMargin = 128;

 private:
  void stamp(std::int32_t centre_index);
  void erase_block(std::int32_t block);

  double resolution_m_;
  SmearKernel kernel_;
  int border_;
  int side_;
  int stride_;
  Eigen::Vector2d corner_map_m_ = Eigen::Vector2d::Zero();  // centre of cell (0, 0)
  std::vector<std::uint8_t> bytes_;
  GridBlocks blocks_;
};

}  // namespace corridor::karto
