// What a beam bundle can reach at most in each part of a search window: the bound of the branch and
// bound of [Olson2009] section III-C.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baselines/karto/beam_offsets.hpp"
#include "baselines/karto/pooled_grid.hpp"
#include "baselines/karto/tile_sweep.hpp"

namespace corridor::karto {

// By squares of positions as wide as a cell of the pooled grid.
class SquareBounds {
 public:
  SquareBounds(const CorrelationGrid& grid, const SweepWindow& window);

  // For one heading: `inside` stay in the grid's rows and columns at every position of the window;
  // of `num_others` nothing is known but that they read at most kOccupied.
  void set(std::span<const BeamOffset> inside, std::size_t num_others);
  // True if a position of these rows and columns, not empty, may sum up to min_sum.
  [[nodiscard]] bool may_reach(std::uint32_t min_sum, const IndexSpan& rows,
                               const IndexSpan& columns) const;

 private:
  PooledGrid pooled_;
  SweepWindow window_;
  int positions_per_square_;
  SweepWindow squares_;
  std::vector<std::int32_t> beams_;
  std::vector<std::uint32_t> bounds_;
};

}  // namespace corridor::karto
