// The true motion of a differential-drive robot with limited acceleration along drawn waypoints.
// It knows no sensor and no slip: the controller sees the true pose, so that the drive of a seed
// depends on nothing but the world and the drive's parameters.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "datasets/simulation/scenario_params.hpp"
#include "datasets/simulation/world.hpp"
#include "slam/core/pose2.hpp"
#include "slam/core/rng.hpp"

namespace corridor::simulation {

struct DriveState {
  Pose2 T_world_base;
  double speed_mps = 0;  // along the base's x axis
  double yaw_rate_radps = 0;
};

struct Drive {
  double step_s = 0;
  // states[k] is the truth at k * step_s; states[0] is at rest. Between two states the robot moves
  // along an arc with the mean of their speeds and yaw rates, exactly.
  std::vector<DriveState> states;
  bool is_complete = false;  // false = a waypoint could not be reached in the time allowed

  [[nodiscard]] double duration_s() const {
    return step_s * static_cast<double>(states.empty() ? 0 : states.size() - 1);
  }
};

struct DrivePlan {
  Pose2 T_world_base_start;
  std::vector<Eigen::Vector2d> waypoints_m;
  double speed_mps = 0;
};

// Corridor's centre line with what the seed draws: start pose, speed, lateral offsets.
DrivePlan draw_plan(const CorridorShape& shape, const DriveParams& params, Rng rng);

// Ends when the last waypoint is reached.
Drive drive_along(const DrivePlan& plan, const DriveParams& params, double step_s);

}  // namespace corridor::simulation
