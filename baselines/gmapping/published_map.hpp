// The map the filter hands out: every used scan ray traced along the best particle's path.
// It counts hits and visits per cell as the original does; it is no Bayesian occupancy map.
#pragma once

#include <span>

#include "baselines/gmapping/gmapping_params.hpp"
#include "baselines/gmapping/scan_points.hpp"
#include "slam/core/grid_map.hpp"
#include "slam/core/pose2.hpp"

namespace corridor::gmapping {

struct UsedScan {
  ScanPoints points;  // all usable beams' end points, in base
  Pose2 T_base_lidar;
};

// Requires as many scans as poses. Per beam a Bresenham line from the LiDAR's cell to the end
// point's: every cell gets a visit, the last one a hit. log_odds = logit(hits / visits) -
// logit(map_occupied_ratio), clamped to +-kMaxAbsLogOdds, so that it is positive exactly where the
// original publishes "occupied". Empty if there is no point.
inline constexpr double kMaxAbsLogOdds = 8;
GridMap published_map(std::span<const UsedScan> scans, std::span<const Pose2> path_map_base,
                      const GmappingParams& params);

}  // namespace corridor::gmapping
