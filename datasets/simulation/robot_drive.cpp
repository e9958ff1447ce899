#include "datasets/simulation/robot_drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "datasets/simulation/route.hpp"
#include "slam/core/expect.hpp"
#include "slam/core/units.hpp"

namespace corridor::simulation {
namespace {

using Eigen::Vector2d;

// A drive may take this many times the time of its straight path, plus the constant.
constexpr double kPatience = 10;
constexpr double kPatience_s = 60;

// Unit vector to the left of the line.
Vector2d across(const Vector2d& from_m, const Vector2d& to_m) {
  const Vector2d along = (to_m - from_m).normalized();
  return {-along.y(), along.x()};
}

// Evenly spaced inner points of the line, then its end, each moved across the line by a drawn
// offset.
void append_arm(const Vector2d& from_m, const Vector2d& to_m, const DriveParams& params, Rng& rng,
                std::vector<Vector2d>& waypoints_m) {
  const int num_parts = params.num_arm_waypoints + 1;
  for (int i = 1; i <= num_parts; ++i) {
    const double offset_m = rng.uniform(-params.lateral_spread_m, params.lateral_spread_m);
    waypoints_m.emplace_back(from_m + (to_m - from_m) * i / num_parts +
                             offset_m * across(from_m, to_m));
  }
}

void append_way_back(const Vector2d& start_m, std::vector<Vector2d>& waypoints_m) {
  std::vector<Vector2d> back_m(waypoints_m.rbegin() + 1, waypoints_m.rend());
  waypoints_m.insert(waypoints_m.end(), back_m.begin(), back_m.end());
  waypoints_m.push_back(start_m);
}

double approach(double value, double target, double max_change) {
  return value + std::clamp(target - value, -max_change, max_change);
}

struct Command {
  double speed_mps = 0;
  double yaw_rate_radps = 0;
};

Command towards(const DriveState& state, const Vector2d& waypoint_m, double cruise_mps,
                const DriveParams& params) {
  const Vector2d to_waypoint = waypoint_m - state.T_world_base.translation_m();
  const double heading_error_rad =
      wrap_angle(std::atan2(to_waypoint.y(), to_waypoint.x()) - state.T_world_base.theta_rad());
  const bool is_turning = std::abs(heading_error_rad) > params.turn_in_place_deg * kRadPerDeg;
  return {is_turning ? 0 : cruise_mps,
          std::clamp(params.heading_gain_per_s * heading_error_rad, -params.yaw_rate_max_radps,
                     params.yaw_rate_max_radps)};
}

// A friction circle: forward and sideways acceleration, as vectors, are at most the floor's grip.
// The driver keeps to a yaw rate at which cornering takes at most half of the square; braking and
// setting off get what is left, and wheels that are driven harder slip.
struct Grip {
  double limit_mps2;
  double fastest_mps;  // the robot after this step, at most

  [[nodiscard]] double yaw_rate_max_radps() const {
    return std::sqrt(0.5) * limit_mps2 / fastest_mps;
  }
  [[nodiscard]] double forward_max_mps2(double yaw_rate_radps) const {
    const double sideways_mps2 = fastest_mps * yaw_rate_radps;
    return std::sqrt(std::max(0.0, limit_mps2 * limit_mps2 - sideways_mps2 * sideways_mps2));
  }
};

// The wheels follow the command, the robot follows its wheels as far as the floor's grip allows.
DriveState next_state(const DriveState& state, const Command& command, const DriveParams& params,
                      double step_s) {
  DriveState next;
  next.wheel_speed_mps =
      approach(state.wheel_speed_mps, command.speed_mps, params.acceleration_mps2 * step_s);
  const bool is_slippery = params.friction_limit_mps2 > 0;
  const Grip grip{params.friction_limit_mps2,
                  state.speed_mps + params.friction_limit_mps2 * step_s};
  const double wanted_radps = is_slippery
                                  ? std::clamp(command.yaw_rate_radps, -grip.yaw_rate_max_radps(),
                                               grip.yaw_rate_max_radps())
                                  : command.yaw_rate_radps;
  next.yaw_rate_radps =
      approach(state.yaw_rate_radps, wanted_radps, params.yaw_acceleration_radps2 * step_s);
  next.speed_mps = is_slippery ? approach(state.speed_mps, next.wheel_speed_mps,
                                          grip.forward_max_mps2(next.yaw_rate_radps) * step_s)
                               : next.wheel_speed_mps;
  const double path_m = 0.5 * (state.speed_mps + next.speed_mps) * step_s;
  const double turn_rad = 0.5 * (state.yaw_rate_radps + next.yaw_rate_radps) * step_s;
  next.T_world_base = state.T_world_base.plus({path_m, 0, turn_rad});
  return next;
}

// Turns by an angle and comes to rest: brakes where the braking angle is all that is left.
void turn_on_the_spot(double angle_rad, const DriveParams& params, Drive& drive) {
  const double sign = angle_rad < 0 ? -1 : 1;
  double left_rad = std::abs(angle_rad);
  const double step_radps = params.yaw_acceleration_radps2 * drive.step_s;
  while (left_rad > 0 || std::abs(drive.states.back().yaw_rate_radps) > 0) {
    const double rate_radps = std::abs(drive.states.back().yaw_rate_radps);
    const double braking_rad = rate_radps * rate_radps / (2 * params.yaw_acceleration_radps2);
    const double wanted_radps =
        left_rad > braking_rad ? params.yaw_rate_max_radps : std::max(0.0, rate_radps - step_radps);
    drive.states.push_back(
        next_state(drive.states.back(), {0, sign * wanted_radps}, params, drive.step_s));
    left_rad -= 0.5 * (rate_radps + std::abs(drive.states.back().yaw_rate_radps)) * drive.step_s;
  }
}

double straight_length_m(const DrivePlan& plan) {
  double length_m = 0;
  Vector2d from_m = plan.T_world_base_start.translation_m();
  for (const Vector2d& waypoint_m : plan.waypoints_m) {
    length_m += (waypoint_m - from_m).norm();
    from_m = waypoint_m;
  }
  return length_m;
}

// Start at the line's first point and heading, speed, all drawn around the parameters.
struct Start {
  Pose2 T_world_base;
  double speed_mps;
};

Start draw_start(const Vector2d& from_m, double heading_rad, const DriveParams& params,
                 const Rng& rng) {
  Rng start = rng.stream("start");
  Rng speed = rng.stream("speed");
  const double x_m = from_m.x() + start.uniform(-params.start_spread_m, params.start_spread_m);
  const double y_m = from_m.y() + start.uniform(-params.start_spread_m, params.start_spread_m);
  const double heading_deg = start.uniform(-params.heading_spread_deg, params.heading_spread_deg);
  return {Pose2(x_m, y_m, heading_rad + heading_deg * kRadPerDeg),
          speed.uniform(params.speed_min_mps, params.speed_max_mps)};
}

// A corner's waypoint moves by one drawn offset across the leg before it and one across that after.
void append_route(const std::vector<Vector2d>& route_m, const DriveParams& params, Rng lateral,
                  std::vector<Vector2d>& waypoints_m) {
  for (std::size_t i = 1; i < route_m.size(); ++i) {
    append_arm(route_m[i - 1], route_m[i], params, lateral, waypoints_m);
    if (i + 1 == route_m.size()) break;
    waypoints_m.back() += lateral.uniform(-params.lateral_spread_m, params.lateral_spread_m) *
                          across(route_m[i], route_m[i + 1]);
  }
}

}  // namespace

DrivePlan draw_plan(const World& world, const DriveParams& params, Rng rng) {
  const std::vector<Vector2d> route_m = route_of(world, params);
  CORRIDOR_EXPECT(!route_m.empty() && (params.stays || route_m.size() >= 2));
  const Vector2d first_leg =
      route_m.size() >= 2 ? Vector2d(route_m[1] - route_m[0]) : Vector2d(1, 0);
  const Start start =
      draw_start(route_m.front(), std::atan2(first_leg.y(), first_leg.x()), params, rng);
  DrivePlan plan{start.T_world_base, {}, start.speed_mps};
  if (params.stays) return plan;
  append_route(route_m, params, rng.stream("lateral"), plan.waypoints_m);
  if (params.is_return_trip) {
    append_way_back(start.T_world_base.translation_m(), plan.waypoints_m);
  }
  return plan;
}

Drive drive_along(const DrivePlan& plan, const DriveParams& params, double step_s) {
  CORRIDOR_EXPECT(step_s > 0 && plan.speed_mps > 0);
  Drive drive{.step_s = step_s, .states = {{plan.T_world_base_start, 0, 0, 0}}};
  const auto num_still = static_cast<std::size_t>(std::llround(params.stand_s / step_s));
  drive.states.resize(1 + num_still, drive.states.front());
  turn_on_the_spot(2 * std::numbers::pi * params.spin_turns, params, drive);
  const double allowed_s = kPatience_s + kPatience * straight_length_m(plan) / plan.speed_mps;
  const std::size_t max_states = drive.states.size() + static_cast<std::size_t>(allowed_s / step_s);
  while (drive.states.size() < max_states) {
    const DriveState& state = drive.states.back();
    while (drive.num_reached < plan.waypoints_m.size() &&
           (plan.waypoints_m[drive.num_reached] - state.T_world_base.translation_m()).norm() <=
               params.waypoint_reach_m) {
      ++drive.num_reached;
    }
    if (drive.num_reached == plan.waypoints_m.size()) {
      drive.is_complete = true;
      return drive;
    }
    const Command command =
        towards(state, plan.waypoints_m[drive.num_reached], plan.speed_mps, params);
    drive.states.push_back(next_state(state, command, params, step_s));
  }
  return drive;
}

}  // namespace corridor::simulation
