#include "baselines/karto/square_bounds.hpp"

#include <algorithm>

namespace corridor::karto {

SquareBounds::SquareBounds(const CorrelationGrid& grid, const SweepWindow& window)
    : pooled_(grid),
      window_(window),
      positions_per_square_(PooledGrid::kSide_cells / window.step_cells),
      squares_{0, 0, 1, (window.count + positions_per_square_ - 1) / positions_per_square_},
      bounds_(squares_.num_positions()) {}

void SquareBounds::set(std::span<const BeamOffset> inside, std::size_t num_others) {
  beams_.clear();
  for (const BeamOffset& beam : inside) {
    const int row = (window_.first_row + beam.row) >> PooledGrid::kShift;
    const int column = (window_.first_column + beam.column) >> PooledGrid::kShift;
    beams_.push_back(row * pooled_.stride() + column);
  }
  std::fill(bounds_.begin(), bounds_.end(), static_cast<std::uint32_t>(num_others * kOccupied));
  TileSweep({pooled_.cells(), pooled_.stride()}, squares_).add(beams_, bounds_.data());
}

bool SquareBounds::may_reach(std::uint32_t min_sum, const IndexSpan& rows,
                             const IndexSpan& columns) const {
  const int last_y = (rows.end - 1) / positions_per_square_;
  const int last_x = (columns.end - 1) / positions_per_square_;
  for (int y = rows.begin / positions_per_square_; y <= last_y; ++y) {
    for (int x = columns.begin / positions_per_square_; x <= last_x; ++x) {
      if (bounds_[static_cast<std::size_t>(y * squares_.count + x)] >= min_sum) return true;
    }
  }
  return false;
}

}  // namespace corridor::karto
