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
  int step_cells = 1;
  int count = 1;
};

enum class EdgeRule {
  kWrap,  // only the linear index is checked: a beam leaving sideways reads another row
  kStop,  // the column is checked as well: such a beam reads nothing
};

// sums[j * count + i] = sum over beams of the grid's value at position (i, j) plus offset. Steps of
// two cells, the coarse searches, run over 16 positions at once (see README, "Speed"); sums are
// exact.
void sweep_window(const CorrelationGrid& grid, std::span<const BeamOffset> offsets,
                  const SweepWindow& window, EdgeRule edge_rule, std::vector<std::uint32_t>& sums);

}  // namespace corridor::karto
