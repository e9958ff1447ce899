// The largest value in each neighbourhood of a correlation grid: what a search may find there at
// most. The multi-level look-up table of [Olson2009] section III-C, one level of it.
#pragma once

#include <cstdint>
#include <vector>

#include "baselines/karto/correlation_grid.hpp"

namespace corridor::karto {

// Cell (column, row) holds the maximum of the grid's cells [8 column, 8 column + 16) x
// [8 row, 8 row + 16), so that a square of up to 9 cells that starts at (x, y) is covered by cell
// (x / 8, y / 8).
class PooledGrid {
 public:
  static constexpr int kShift = 3;
  static constexpr int kSide_cells = 1 << kShift;

  explicit PooledGrid(const CorrelationGrid& grid);

  [[nodiscard]] int stride() const { return stride_; }
  // At least CorrelationGrid::kMargin readable bytes lie behind the last row.
  [[nodiscard]] const std::uint8_t* cells() const { return cells_.data(); }

 private:
  void pool(const CorrelationGrid& grid, std::int32_t block);
  void widen(std::uint8_t* row) const;

  int num_columns_;
  int num_rows_;
  int stride_;
  std::vector<std::uint8_t> cells_;
};

}  // namespace corridor::karto
