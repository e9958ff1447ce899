// Trajectories for tests: random walks, disturbed copies, pairs made by hand.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "bench/metrics/association.hpp"
#include "slam/core/rng.hpp"
#include "slam/core/trajectory.hpp"

namespace corridor::metrics {

inline Trajectory trajectory_of(const std::vector<std::pair<double, Pose2>>& stamped_poses) {
  Trajectory trajectory;
  for (const auto& [stamp_s, pose] : stamped_poses) {
    if (!trajectory.append({timestamp_from_seconds(stamp_s), pose, std::nullopt})) return {};
  }
  return trajectory;
}

// 0.1 s and about 0.2 m per step, turning.
inline Trajectory random_walk(Rng& rng, int num_poses) {
  Trajectory trajectory;
  Pose2 pose(rng.uniform(-5, 5), rng.uniform(-5, 5), rng.uniform(-3, 3));
  for (int i = 0; i < num_poses; ++i) {
    static_cast<void>(trajectory.append({timestamp_from_seconds(0.1 * i), pose, std::nullopt}));
    pose = pose.plus({rng.normal(0.2, 0.05), rng.normal(0, 0.02), rng.normal(0, 0.2)});
  }
  return trajectory;
}

// The same drive seen in another frame, with noise on each pose.
inline Trajectory disturbed(const Trajectory& trajectory, const Pose2& T_map_world, double sigma_m,
                            double sigma_rad, Rng& rng) {
  Trajectory result;
  for (const TrajectoryPose& pose : trajectory.poses()) {
    const Pose2 T_map_base =
        (T_map_world * pose.T_map_base)
            .plus({rng.normal(0, sigma_m), rng.normal(0, sigma_m), rng.normal(0, sigma_rad)});
    static_cast<void>(result.append({pose.stamp, T_map_base, std::nullopt}));
  }
  return result;
}

inline Association associated(const Trajectory& estimate, const Trajectory& truth) {
  return associate(estimate, truth, AssociationRule::kNearest);
}

}  // namespace corridor::metrics
