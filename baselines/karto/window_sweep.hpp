// Sums of grid values under a scan for every position of a search window, one heading at a time.
// Beams that leave the grid are its business, and headings; the sums themselves are TileSweep's.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baselines/karto/beam_offsets.hpp"
#include "baselines/karto/correlation_grid.hpp"
#include "baselines/karto/tile_sweep.hpp"

namespace corridor::karto {

enum class EdgeRule {
  kWrap,  // only the linear index is checked: a beam leaving sideways reads another row
  kStop,  // the column is checked as well: such a beam reads nothing
};

// One heading of a search: what to look up, and the sums it gives. Kept from one search to the
// next for its memory.
struct HeadingSweep {
  std::vector<BeamOffset> offsets;
  std::span<std::uint32_t> sums;
  // Scratch: beams that may be read at every position, those that may not, and those that stay in
  // the grid's rows and columns.
  std::vector<std::int32_t> inner;
  std::vector<BeamOffset> leaving;
  std::vector<BeamOffset> inside;
};

// For each heading sums[j * count + i] = sum over its beams of the grid's value at position (i, j)
// plus offset, exact where it is at least `min_sum`. A smaller one may come out too small: squares
// of positions that cannot reach min_sum are left out. Every `sums` has num_positions() elements.
void sweep_window(const CorrelationGrid& grid, const SweepWindow& window, EdgeRule edge_rule,
                  std::uint32_t min_sum, std::span<HeadingSweep> headings);

}  // namespace corridor::karto
