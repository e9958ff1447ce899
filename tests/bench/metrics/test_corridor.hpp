// A drive through the corridor, the scans an ideal LiDAR with noise takes on it, and the map made
// of them at whatever poses a system is said to have estimated.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "datasets/simulation/ray_casting.hpp"
#include "datasets/simulation/world.hpp"
#include "slam/core/rng.hpp"
#include "slam/core/scan.hpp"
#include "slam/core/trajectory.hpp"
#include "slam/mapping/occupancy_mapper.hpp"

namespace corridor::metrics {

inline constexpr double kTestRange_m = 4.5;
inline constexpr double kTestRangeSigma_m = 0.015;
inline constexpr int kTestBeams = 360;

// From (2.5, c/2) along the first arm, a turn of 0.5 rad/s on the spot, then along the second arm.
inline Trajectory drive(const simulation::CorridorShape& shape, double step_m = 0.1) {
  const double turn_rad = std::numbers::pi - shape.alpha_rad;
  const double corner_x_m = shape.b_m - shape.c_m / 2 / std::tan(shape.alpha_rad / 2);
  std::vector<Pose2> poses;
  for (double x_m = 2.5; x_m < corner_x_m; x_m += step_m) {
    poses.emplace_back(x_m, shape.c_m / 2, 0);
  }
  for (double angle = 0; angle < turn_rad; angle += 0.05) {
    poses.emplace_back(corner_x_m, shape.c_m / 2, angle);
  }
  const double corner_to_end_m = shape.a_m - shape.c_m / 2 / std::tan(shape.alpha_rad / 2);
  for (double s_m = 0; s_m < corner_to_end_m - 2.5; s_m += step_m) {
    poses.emplace_back(corner_x_m + s_m * std::cos(turn_rad),
                       shape.c_m / 2 + s_m * std::sin(turn_rad), turn_rad);
  }
  Trajectory truth;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    static_cast<void>(
        truth.append({{static_cast<std::int64_t>(i) * 100'000'000}, poses[i], std::nullopt}));
  }
  return truth;
}

inline std::vector<LaserScan> take_scans(const simulation::World& world, const Trajectory& truth,
                                         Rng& rng, double range_m = kTestRange_m) {
  const simulation::RayCaster caster(world);
  std::vector<LaserScan> scans;
  for (const TrajectoryPose& pose : truth.poses()) {
    LaserScan scan;
    scan.stamp = pose.stamp;
    scan.angle_increment_rad = 2 * std::numbers::pi / kTestBeams;
    scan.angle_min_rad = -std::numbers::pi + scan.angle_increment_rad / 2;
    scan.range_max_m = range_m;
    for (std::size_t i = 0; i < kTestBeams; ++i) {
      const auto hit_m = caster.range_m(pose.T_map_base.translation_m(),
                                        pose.T_map_base.theta_rad() + scan.angle_rad(i), range_m);
      const double noise_m = rng.normal(0, kTestRangeSigma_m);
      scan.is_valid.push_back(hit_m ? 1 : 0);
      scan.ranges_m.push_back(static_cast<float>(hit_m ? *hit_m + noise_m : range_m + 1));
    }
    scans.push_back(std::move(scan));
  }
  return scans;
}

inline GridMap map_at(const std::vector<LaserScan>& scans, const Trajectory& estimate,
                      double resolution_m = 0.05) {
  std::vector<mapping::PosedScan> posed;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    posed.push_back({estimate[i].T_map_base, &scans[i]});
  }
  mapping::OccupancyMapperParams params;
  params.resolution_m = resolution_m;
  return mapping::build_occupancy_map(posed, params);
}

// The truth with each pose changed; stamps are kept.
inline Trajectory changed(const Trajectory& truth,
                          const std::function<Pose2(std::size_t, const Pose2&)>& change) {
  Trajectory estimate;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    static_cast<void>(
        estimate.append({truth[i].stamp, change(i, truth[i].T_map_base), std::nullopt}));
  }
  return estimate;
}

inline Trajectory in_frame(const Trajectory& truth, const Pose2& T_map_world) {
  return changed(truth, [&](std::size_t, const Pose2& pose) { return T_map_world * pose; });
}

}  // namespace corridor::metrics
