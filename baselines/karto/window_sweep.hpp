// Sums of grid values under a scan for every position of a search window, one heading at a time.
// The brute-force correlation of [Olson2009] section III, organised by rows instead of by poses.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baselines/karto/beam_offsets.hpp"
#include "baselines/karto/correlation_grid.hpp"

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
};

enum class EdgeRule {
  kWrap,  // only the linear index is checked: a beam leaving sideways reads another row
  kStop,  // the column is checked as well: such a beam reads nothing
};

// One heading of a search: what to look up, and the sums it gives. Kept from one search to the
// next for its memory.
struct HeadingSweep {
  std::vector<BeamOffset> offsets;
  std::span<std::uint32_t> sums;
  std::vector<std::int32_t> inner;  // scratch: beams that may be read at every position
};

// For each heading sums[j * count + i] = sum over its beams of the grid's value at position (i, j)
// plus offset, exact where it is at least `min_sum`. A smaller one may come out too small: such
// positions are given up once their remaining beams cannot lift them to min_sum. Every `sums` has
// num_positions() elements. Headings are shared out to the threads of the present task arena.
void sweep_window(const CorrelationGrid& grid, const SweepWindow& window, EdgeRule edge_rule,
                  std::uint32_t min_sum, std::span<HeadingSweep> headings);

}  // namespace corridor::karto
