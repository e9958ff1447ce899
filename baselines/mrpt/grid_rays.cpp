#include "baselines/mrpt/grid_rays.hpp"

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/poses/CPose2D.h>

#include <numbers>

#include "baselines/mrpt/conversions.hpp"

namespace corridor::mrpt {

struct GridRays::Grid {
  ::mrpt::maps::COccupancyGridMap2D map;
};

GridRays::GridRays(const GridMap& map) : grid_(std::make_unique<Grid>()) {
  const double resolution_m = map.resolution_m();
  const Eigen::Vector2d upper_m =
      map.origin_m() + resolution_m * Eigen::Vector2d(map.num_columns(), map.num_rows());
  grid_->map.setSize(static_cast<float>(map.origin_m().x()), static_cast<float>(upper_m.x()),
                     static_cast<float>(map.origin_m().y()), static_cast<float>(upper_m.y()),
                     static_cast<float>(resolution_m));
  for (int row = 0; row < map.num_rows(); ++row) {
    for (int column = 0; column < map.num_columns(); ++column) {
      const Eigen::Vector2d centre_m = map.centre_m(column, row);
      const double occupied = probability_from_log_odds(map.at(column, row).log_odds);
      // MRPT's cells say how likely they are free.
      grid_->map.setCell(grid_->map.x2idx(static_cast<float>(centre_m.x())),
                         grid_->map.y2idx(static_cast<float>(centre_m.y())),
                         static_cast<float>(1 - occupied));
    }
  }
}

GridRays::~GridRays() = default;

std::vector<float> GridRays::cast(const Pose2& T_map_sensor, std::size_t num_beams,
                                  double max_m) const {
  ::mrpt::obs::CObservation2DRangeScan scan;
  scan.aperture = static_cast<float>(2 * std::numbers::pi * static_cast<double>(num_beams - 1) /
                                     static_cast<double>(num_beams));
  scan.rightToLeft = true;
  scan.maxRange = static_cast<float>(max_m);
  constexpr float kOccupied = 0.6F;
  grid_->map.laserScanSimulator(scan, to_mrpt(T_map_sensor), kOccupied, num_beams);
  std::vector<float> ranges_m(num_beams);
  for (std::size_t i = 0; i < num_beams; ++i) ranges_m[i] = scan.getScanRange(i);
  return ranges_m;
}

}  // namespace corridor::mrpt
