#include "baselines/karto/pooled_grid.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace corridor::karto {
namespace {

using EightCells = std::array<std::uint8_t, PooledGrid::kSide_cells>;

// Of a square of 8 by 8 cells, or of its first rows.
std::uint8_t max_of_square(const std::uint8_t* cells, int stride, int num_rows) {
  EightCells largest{};
  for (int row = 0; row < num_rows; ++row) {
    EightCells values;
    std::memcpy(values.data(), cells + row * stride, values.size());
    for (std::size_t i = 0; i < values.size(); ++i) largest[i] = std::max(largest[i], values[i]);
  }
  return *std::max_element(largest.begin(), largest.end());
}

}  // namespace

// Rows and columns are padded by one, for the squares that begin in the last ones.
PooledGrid::PooledGrid(const CorrelationGrid& grid)
    : num_columns_((grid.stride() >> kShift) + 1),
      num_rows_((grid.side_cells() >> kShift) + 1),
      stride_(num_columns_ + 1),
      cells_(static_cast<std::size_t>((num_rows_ + 1) * stride_ + CorrelationGrid::kMargin), 0) {
  for (const std::int32_t block : grid.blocks().drawn()) pool(grid, block);
  for (int row = 0; row < num_rows_; ++row) widen(cells_.data() + row * stride_);
}

// What was drawn in a block, with what of it lies beside the block.
void PooledGrid::pool(const CorrelationGrid& grid, std::int32_t block) {
  const Eigen::Vector2i first = grid.blocks().first_cell(block);
  const int reach = grid.smear_reach_cells();
  const int end_row = std::min(first.y() + GridBlocks::kSide_cells + reach, grid.side_cells());
  const int end_column = std::min(first.x() + GridBlocks::kSide_cells + reach, grid.stride());
  const int begin_column = std::max(first.x() - reach, 0) >> kShift;
  for (int row = std::max(first.y() - reach, 0) >> kShift; row << kShift < end_row; ++row) {
    const int num_rows = std::min(kSide_cells, grid.side_cells() - (row << kShift));
    for (int column = begin_column; column << kShift < end_column; ++column) {
      cells_[static_cast<std::size_t>(row * stride_ + column)] =
          max_of_square(grid.cells() + (row << kShift) * grid.stride() + (column << kShift),
                        grid.stride(), num_rows);
    }
  }
}

// The maximum of each cell, its neighbours to the right and above, and the one between.
void PooledGrid::widen(std::uint8_t* row) const {
  const std::uint8_t* const above = row + stride_;
  for (int i = 0; i < num_columns_; ++i) {
    row[i] = std::max(std::max(row[i], row[i + 1]), std::max(above[i], above[i + 1]));
  }
}

}  // namespace corridor::karto
