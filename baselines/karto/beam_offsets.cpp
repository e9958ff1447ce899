#include "baselines/karto/beam_offsets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "baselines/karto/round_cells.hpp"

namespace corridor::karto {
namespace {

// Beams are rotated by blocks, in a loop without branches, and sorted out afterwards.
constexpr Eigen::Index kBlock = 64;

}  // namespace

void fill_beam_offsets(const PointColumns& beams_sensor_m, double heading_rad,
                       const CorrelationGrid& grid, std::vector<BeamOffset>& offsets) {
  const double cells_per_m = 1 / grid.resolution_m();
  const double c = std::cos(heading_rad) * cells_per_m;
  const double s = std::sin(heading_rad) * cells_per_m;
  // A linear offset beyond the number of cells leads out of the grid from every cell of it.
  const std::int64_t limit = grid.num_cells();
  std::array<std::int32_t, kBlock> columns;
  std::array<std::int32_t, kBlock> rows;
  offsets.clear();
  for (Eigen::Index begin = 0; begin < beams_sensor_m.rows(); begin += kBlock) {
    const auto count = static_cast<std::size_t>(std::min(kBlock, beams_sensor_m.rows() - begin));
    const double* const x_m = beams_sensor_m.col(0).data() + begin;
    const double* const y_m = beams_sensor_m.col(1).data() + begin;
    for (std::size_t i = 0; i < count; ++i) {
      columns[i] = round_to_cell(std::fma(c, x_m[i], -(s * y_m[i])));
      rows[i] = round_to_cell(std::fma(s, x_m[i], c * y_m[i]));
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t linear = columns[i] + std::int64_t{rows[i]} * grid.stride();
      if (std::abs(linear) >= limit) continue;
      offsets.push_back({static_cast<std::int32_t>(linear), columns[i], rows[i]});
    }
  }
}

}  // namespace corridor::karto
