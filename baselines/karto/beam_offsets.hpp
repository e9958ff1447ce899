// End points of a scan as index offsets into a correlation grid, for one heading.
#pragma once

#include <cstdint>
#include <vector>

#include "baselines/karto/correlation_grid.hpp"

namespace corridor::karto {

struct BeamOffset {
  std::int32_t linear = 0;  // column + row * stride
  std::int32_t column = 0;
  std::int32_t row = 0;
};

// Rotates each end point by `heading_rad` and rounds to cells relative to the sensor's cell. Points
// that no cell of the grid leads to are left out; requires finite coordinates of at most 1e9 cells.
void fill_beam_offsets(const PointColumns& beams_sensor_m, double heading_rad,
                       const CorrelationGrid& grid, std::vector<BeamOffset>& offsets);

}  // namespace corridor::karto
