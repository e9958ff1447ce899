#include "baselines/karto/beam_offsets.hpp"

#include <cmath>

#include "baselines/karto/round_cells.hpp"

namespace corridor::karto {

void fill_beam_offsets(std::span<const Eigen::Vector2d> beams_sensor_m, double heading_rad,
                       const CorrelationGrid& grid, std::vector<BeamOffset>& offsets) {
  const double cells_per_m = 1 / grid.resolution_m();
  const double c = std::cos(heading_rad) * cells_per_m;
  const double s = std::sin(heading_rad) * cells_per_m;
  // Beyond it every linear index is outside the grid, and int32 could overflow.
  const double limit_cells = 2.0 * grid.num_cells() / grid.stride();
  offsets.clear();
  for (const Eigen::Vector2d& beam_m : beams_sensor_m) {
    const double column = c * beam_m.x() - s * beam_m.y();
    const double row = s * beam_m.x() + c * beam_m.y();
    if (!(std::abs(row) < limit_cells && std::abs(column) < grid.num_cells())) continue;
    const auto column_cells = round_to_cell(column);
    const auto row_cells = round_to_cell(row);
    offsets.push_back({column_cells + row_cells * grid.stride(), column_cells});
  }
}

}  // namespace corridor::karto
