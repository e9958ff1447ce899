// An occupancy grid from scans at known poses: log-odds of hits and misses along every beam, cells
// traversed exactly [Amanatides1987]. The common mapper of the suite, and the fusion system's.
// It does not move poses and does not know of submaps.
#pragma once

#include <span>

#include "slam/core/grid_map.hpp"
#include "slam/core/params.hpp"
#include "slam/core/scan.hpp"

namespace corridor::mapping {

struct OccupancyMapperParams {
  double resolution_m = 0.05;
  double hit_log_odds = 0.85;
  double miss_log_odds = -0.4;
  double max_abs_log_odds = 8.0;
  bool use_no_returns = false;  // clear free space along beams without return, up to range_max_m

  template <class V>
  static void visit(OccupancyMapperParams& p, V&& v) {
    v(ParamInfo{"map_resolution_m", "m", "side of a cell", 0.005, 1}, p.resolution_m);
    v(ParamInfo{"map_hit_log_odds", "1", "added to the cell of a beam's end point", 0, 10},
      p.hit_log_odds);
    v(ParamInfo{"map_miss_log_odds", "1", "added to each cell a beam passes", -10, 0},
      p.miss_log_odds);
    v(ParamInfo{"map_max_abs_log_odds", "1", "clamp", 0.1, 100}, p.max_abs_log_odds);
    v(ParamInfo{"map_use_no_returns", "",
                "clear along beams without return up to the sensor's limit"},
      p.use_no_returns);
  }
};

struct PosedScan {
  Pose2 T_map_base;  // at the scan's stamp
  const LaserScan* scan = nullptr;
  // Motion of the base during the sweep per second, (x [m/s], y [m/s], theta [rad/s]): each beam is
  // drawn from where it was taken. Scans taken all at once have none.
  Eigen::Vector3d twist_base = Eigen::Vector3d::Zero();
};

// Sized to the scans' extent plus one cell; empty if there is no valid beam.
GridMap build_occupancy_map(std::span<const PosedScan> scans, const OccupancyMapperParams& params);

}  // namespace corridor::mapping
