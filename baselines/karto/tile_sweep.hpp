// Adds up what beams read at the positions of a search window, many positions at once.
// The brute-force correlation of [Olson2009] section III, organised by rows instead of by poses.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

namespace corridor::karto {

// Positions: cell (first_column + step * i, first_row + step * j) for i, j in [0, count).
struct SweepWindow {
  int first_column = 0;
  int first_row = 0;
  int step_cells = 1;  // 1 or 2
  int count = 1;

  [[nodiscard]] std::size_t num_positions() const {
    return static_cast<std::size_t>(count) * static_cast<std::size_t>(count);
  }
  [[nodiscard]] int span_cells() const { return step_cells * (count - 1); }
  // Linear index of the first position of a row of them.
  [[nodiscard]] std::int64_t index_of(int row, std::int64_t stride) const {
    return first_column + (first_row + std::int64_t{step_cells} * row) * stride;
  }
};

// Positions [begin, end) of a row, or rows of them.
struct IndexSpan {
  int begin = 0;
  int end = 0;

  [[nodiscard]] IndexSpan common(const IndexSpan& other) const {
    return {std::max(begin, other.begin), std::min(end, other.end)};
  }
};

// Values of at most kOccupied, row after row.
struct ByteRows {
  const std::uint8_t* first = nullptr;  // cell (0, 0)
  std::int64_t stride = 0;              // bytes from row to row
};

// Beams are linear offsets that may be read at every position; up to kMaxOverrun bytes beyond the
// last position of a row are read as well. sums[j * count + i] is that of position (i, j).
class TileSweep {
 public:
  static constexpr int kMaxOverrun = 96;
  static constexpr int kTileRows = 4;

  // Requires steps of 1 or 2 cells.
  TileSweep(const ByteRows& cells, const SweepWindow& window);

  // Adds to the sums of all positions.
  void add(std::span<const std::int32_t> beams, std::uint32_t* sums) const;

  // Positions of one tile along a row.
  [[nodiscard]] int tile_columns() const;
  // Adds to those of the tile that begins at a position, as far as it lies in the window.
  void add_tile(std::span<const std::int32_t> beams, int row, int column,
                std::uint32_t* sums) const;

 private:
  template <int kStep>
  void add_all(std::span<const std::int32_t> beams, std::uint32_t* sums) const;
  template <int kStep>
  void add_one(std::span<const std::int32_t> beams, int row, int column, std::uint32_t* sums) const;
  template <class Shape>
  int add_rows(std::span<const std::int32_t> beams, int row, std::uint32_t* sums) const;
  template <class Shape>
  void add_shape(std::span<const std::int32_t> beams, int row, int column,
                 std::uint32_t* sums) const;

  ByteRows cells_;
  SweepWindow window_;
};

}  // namespace corridor::karto
