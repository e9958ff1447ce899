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

// Sweeps windows; keeps its scratch memory from one to the next.
class WindowSweep {
 public:
  // sums[j * count + i] = sum over beams of the grid's value at position (i, j) plus offset, exact
  // where it is at least `min_sum`. A smaller one may be reported too small: such positions are
  // given up once their remaining beams cannot lift them to min_sum. sums has num_positions()
  // elements.
  void run(const CorrelationGrid& grid, std::span<const BeamOffset> offsets,
           const SweepWindow& window, EdgeRule edge_rule, std::uint32_t min_sum,
           std::span<std::uint32_t> sums);

 private:
  std::vector<std::int32_t> inner_;  // beams that may be read at every position
};

}  // namespace corridor::karto
