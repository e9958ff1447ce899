// Ideal scans in the paper's corridor with the suite's LiDAR, for the benchmarks around scans.
#pragma once

#include <numbers>
#include <vector>

#include "datasets/simulation/ray_casting.hpp"
#include "datasets/simulation/world.hpp"
#include "slam/core/scan.hpp"

namespace corridor {

inline constexpr std::size_t kNumBeams = 360;
inline constexpr double kRangeMax_m = 4.5;

// An ideal scan at a pose in the corridor; beams without return are marked as such.
inline LaserScan cast_scan(const simulation::RayCaster& caster, const Pose2& T_world_base,
                           double range_max_m = kRangeMax_m) {
  LaserScan scan;
  scan.angle_increment_rad = 2 * std::numbers::pi / static_cast<double>(kNumBeams);
  scan.range_max_m = range_max_m;
  for (std::size_t beam = 0; beam < kNumBeams; ++beam) {
    const auto range_m = caster.range_m(
        T_world_base.translation_m(), T_world_base.theta_rad() + scan.angle_rad(beam), range_max_m);
    scan.ranges_m.push_back(static_cast<float>(range_m.value_or(range_max_m + 1)));
    scan.is_valid.push_back(range_m.has_value() ? 1 : 0);
  }
  return scan;
}

// Poses along the first arm, 0.1 m apart.
inline std::vector<Pose2> drive_along(std::size_t num_poses) {
  std::vector<Pose2> poses;
  for (std::size_t index = 0; index < num_poses; ++index) {
    poses.emplace_back(2.5 + 0.1 * static_cast<double>(index), 2.5, 0.01);
  }
  return poses;
}

}  // namespace corridor
