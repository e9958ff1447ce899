// The true motion of a differential-drive robot with limited acceleration along drawn waypoints,
// and that of its wheels where the floor's grip is limited. It knows no sensor and no slip event:
// the controller sees the true pose, so that the drive of a seed depends on nothing but the world
// and the drive's parameters.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "datasets/simulation/scenario_params.hpp"
#include "datasets/simulation/world.hpp"
#include "slam/core/pose2.hpp"
#include "slam/core/rng.hpp"

namespace corridor::simulation {

struct DriveState {
  Pose2 T_world_base;
  double speed_mps = 0;        // along the base's x axis
  double wheel_speed_mps = 0;  // mean of the wheels' rims; differs from the speed while they slip
  double yaw_rate_radps = 0;
};

struct Drive {
  double step_s = 0;
  // states[k] is the truth at k * step_s; states[0] is at rest. Between two states the robot moves
  // along an arc with the mean of their speeds and yaw rates, exactly.
  std::vector<DriveState> states;
  std::size_t num_reached = 0;  // waypoints
  bool is_complete = false;     // false = a waypoint could not be reached in the time allowed

  [[nodiscard]] double duration_s() const {
    return step_s * static_cast<double>(states.empty() ? 0 : states.size() - 1);
  }
};

struct DrivePlan {
  Pose2 T_world_base_start;
  std::vector<Eigen::Vector2d> waypoints_m;
  double speed_mps = 0;
};

// The world's route (route_of()) with what the seed draws: start pose,
// speed, lateral offsets. Requires a corridor or a route of two points or more, unless
// params.stays.
DrivePlan draw_plan(const World& world, const DriveParams& params, Rng rng);

// Stands, turns on the spot, then drives until the last waypoint is reached.
Drive drive_along(const DrivePlan& plan, const DriveParams& params, double step_s);

}  // namespace corridor::simulation
