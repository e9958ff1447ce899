// End points of a scan as index offsets into a correlation grid, for one heading.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "baselines/karto/correlation_grid.hpp"

namespace corridor::karto {

struct BeamOffset {
  std::int32_t linear = 0;  // column + row * stride
  std::int32_t column = 0;
};

// Rotates each end point by `heading_rad` and rounds to cells relative to the sensor's cell. Points
// that are not finite, or farther than any grid reaches, are left out.
void fill_beam_offsets(std::span<const Eigen::Vector2d> beams_sensor_m, double heading_rad,
                       const CorrelationGrid& grid, std::vector<BeamOffset>& offsets);

}  // namespace corridor::karto
