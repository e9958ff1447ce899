// MRPT's ray tracing through an occupancy grid, to compare the suite's own ray casting with.
#pragma once

#include <memory>
#include <vector>

#include "slam/core/grid_map.hpp"
#include "slam/core/pose2.hpp"

namespace corridor::mrpt {

class GridRays {
 public:
  explicit GridRays(const GridMap& map);
  ~GridRays();

  // Ranges [m] of `num_beams` rays all around, the first straight back, counter-clockwise; rays
  // that meet no occupied cell within max_m give max_m. Exact to about a cell.
  [[nodiscard]] std::vector<float> cast(const Pose2& T_map_sensor, std::size_t num_beams,
                                        double max_m) const;

 private:
  struct Grid;
  std::unique_ptr<Grid> grid_;
};

}  // namespace corridor::mrpt
