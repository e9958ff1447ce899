// The rules of a scenario: ranges of each parameter, and those that tie world, drive and rates.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/simulation/route.hpp"
#include "datasets/simulation/scenario.hpp"
#include "slam/core/units.hpp"

namespace corridor::simulation {
namespace {

// The robot is a disc of this radius and must have room for it everywhere on its way.
constexpr double kClearance_m = 0.5;
// The least length of an arm's straight part between its first and its last waypoint.
constexpr double kMinArm_m = 1.0;

template <class P>
void append(const char* section, const P& params, std::vector<std::string>& found) {
  for (const std::string& line : param_violations(params)) {
    found.push_back(fmt::format("{}.{}", section, line));
  }
}

void check_rate(const char* key, double rate_hz, double imu_rate_hz,
                std::vector<std::string>& found) {
  const double ratio = imu_rate_hz / rate_hz;
  if (ratio < 1 || std::abs(ratio - std::round(ratio)) > 1e-9 * ratio) {
    found.push_back(fmt::format("{} = {}: expected a whole fraction of imu.rate_hz = {}", key,
                                rate_hz, imu_rate_hz));
  }
}

// Every corner of the box of shapes that a seed may draw.
std::vector<CorridorShape> extreme_shapes(const Scenario& scenario) {
  const double spread = scenario.draw.length_spread;
  const double alpha_spread_rad = scenario.draw.alpha_spread_deg * kRadPerDeg;
  std::vector<CorridorShape> shapes;
  for (const double a : {-spread, spread}) {
    for (const double b : {-spread, spread}) {
      for (const double c : {-spread, spread}) {
        for (const double alpha : {-alpha_spread_rad, alpha_spread_rad}) {
          CorridorShape shape = *scenario.world.corridor;
          shape.a_m *= 1 + a;
          shape.b_m *= 1 + b;
          shape.c_m *= 1 + c;
          shape.alpha_rad += alpha;
          shapes.push_back(shape);
        }
      }
    }
  }
  return shapes;
}

// The path on which the robot comes to rest: its brakes hold no better than what the floor gives
// beside a turn.
double braking_path_m(const DriveParams& drive) {
  const double braking_mps2 =
      drive.friction_limit_mps2 > 0
          ? std::min(drive.acceleration_mps2, std::sqrt(0.5) * drive.friction_limit_mps2)
          : drive.acceleration_mps2;
  return drive.speed_max_mps * drive.speed_max_mps / (2 * braking_mps2);
}

// How far the robot may go past a waypoint before it has come to rest.
double overshoot_m(const DriveParams& drive) {
  return drive.stays ? 0 : std::max(0.0, braking_path_m(drive) - drive.waypoint_reach_m);
}

// Room beside a route through the corridor of this shape. The corner's waypoint is moved by two
// drawn offsets, one across each arm: across the other arm the second counts by its cosine.
double free_width_m(const CorridorShape& shape, const DriveParams& drive) {
  const double at_corner_m = drive.lateral_spread_m * (1 + std::abs(std::cos(shape.alpha_rad)));
  return 0.5 * shape.c_m - std::max(drive.start_spread_m, at_corner_m) - overshoot_m(drive);
}

// How far a seed may move each point of a drawn route: the start by a square; a bend by one offset
// across the leg before it and one across that after, at most their longer diagonal; the points
// between by one offset.
std::vector<double> most_moved_m(const std::vector<Eigen::Vector2d>& route_m,
                                 const DriveParams& drive) {
  const double spread_m = drive.stays ? 0 : drive.lateral_spread_m;
  std::vector<double> moved_m(route_m.size(),
                              std::max(std::sqrt(2.0) * drive.start_spread_m, spread_m));
  for (std::size_t i = 1; i < route_m.size(); ++i) {
    double cosine = -1;  // the last point has no leg after it: one offset alone
    if (i + 1 < route_m.size()) {
      const Eigen::Vector2d before_m = route_m[i] - route_m[i - 1];
      const Eigen::Vector2d after_m = route_m[i + 1] - route_m[i];
      cosine = std::abs(before_m.normalized().dot(after_m.normalized()));
    }
    moved_m[i] = spread_m * (cosine < 0 ? 1 : std::sqrt(2 * (1 + cosine)));
  }
  return moved_m;
}

struct ArmLengths {
  double first_m, second_m;  // along the centre lines, first waypoint to corner to last
};

ArmLengths arm_lengths(const CorridorShape& shape, const DriveParams& drive) {
  // The centre lines meet this far along either of them before the outer corner's projection.
  const double setback_m =
      0.5 * shape.c_m * (1 + std::cos(shape.alpha_rad)) / std::sin(shape.alpha_rad);
  return {shape.b_m - setback_m - drive.end_margin_m, shape.a_m - setback_m - drive.end_margin_m};
}

// least_path_m: of any drive that a seed may draw.
void check_slips(const Scenario& scenario, double least_path_m, std::vector<std::string>& found) {
  const DriveParams& drive = scenario.drive;
  const double least_s =
      drive.stand_s + (drive.stays ? 0 : std::max(0.0, least_path_m) / drive.speed_max_mps);
  if (scenario.slip.num_slips * scenario.slip.duration_s > least_s) {
    found.push_back(
        fmt::format("slip.num_slips = {}: expected slips of {:.3g} s in all at most, "
                    "the shortest drive",
                    scenario.slip.num_slips, least_s));
  }
}

void check_route(const Scenario& scenario, const CorridorShape& shape,
                 std::vector<std::string>& found) {
  const DriveParams& drive = scenario.drive;
  if (free_width_m(shape, drive) < kClearance_m) {
    found.push_back(fmt::format(
        "drive.lateral_spread_m = {}: expected at least {} m of room on both sides of the route in "
        "the narrowest corridor drawn, {:.3g} m wide, after start_spread_m, lateral_spread_m and "
        "braking",
        drive.lateral_spread_m, kClearance_m, shape.c_m));
  }
  if (drive.end_margin_m - drive.start_spread_m < kClearance_m) {
    found.push_back(
        fmt::format("drive.end_margin_m = {}: expected at least {} m more than "
                    "start_spread_m = {}",
                    drive.end_margin_m, kClearance_m, drive.start_spread_m));
  }
  const ArmLengths arms = arm_lengths(shape, drive);
  if (std::min(arms.first_m, arms.second_m) < kMinArm_m) {
    found.push_back(
        fmt::format("drive.end_margin_m = {}: expected arms of at least {} m between "
                    "the waypoints, not {:.3g} m and {:.3g} m",
                    drive.end_margin_m, kMinArm_m, arms.first_m, arms.second_m));
    return;
  }
  // What the drawn offsets can at most take from the way.
  const double shortened_m =
      2 * drive.start_spread_m + 4 * drive.lateral_spread_m + 4 * drive.waypoint_reach_m;
  check_slips(scenario, arms.first_m + arms.second_m - shortened_m, found);
}

// People walk along the route, beside it by a drawn offset.
void check_people(const Scenario& scenario, const World& world, std::vector<std::string>& found) {
  const PeopleParams& people = scenario.people;
  if (people.num_people == 0) return;
  const std::vector<Eigen::Vector2d> route_m = route_of(world, scenario.drive);
  if (route_m.size() < 2) {
    found.push_back(
        fmt::format("people.num_people = {}: expected a route of two points or more to walk along",
                    people.num_people));
    return;
  }
  const double half_width_m = people.lateral_spread_m + people.radius_m;
  if (const auto leg = blocked_leg(world, route_m, half_width_m)) {
    found.push_back(fmt::format(
        "people.lateral_spread_m = {}: expected no wall within it and radius_m = {} of the route, "
        "but one stands beside leg {}",
        people.lateral_spread_m, people.radius_m, *leg + 1));
  }
}

// The paper's corridor at every edge of what a seed may draw; the first that is unfit.
void check_corridor(const Scenario& scenario, std::vector<std::string>& found) {
  for (const CorridorShape& shape : extreme_shapes(scenario)) {
    std::vector<std::string> problems = violations(shape);
    for (std::string& line : problems) line += ", at the edge of what [draw] allows";
    if (problems.empty()) check_route(scenario, shape, problems);
    if (problems.empty()) check_people(scenario, make_corridor(shape), problems);
    if (problems.empty()) continue;
    found.insert(found.end(), problems.begin(), problems.end());
    return;  // the other edges would say the same again
  }
}

// The route of a drawn world, at every edge of what a seed may draw.
void check_room(const Scenario& scenario, std::vector<std::string>& found) {
  const std::vector<Eigen::Vector2d>& route_m = scenario.world.route_m;
  std::vector<double> needed_m = most_moved_m(route_m, scenario.drive);
  for (double& needed : needed_m) needed += kClearance_m + overshoot_m(scenario.drive);
  if (const auto spot = tight_spot(scenario.world, route_m, needed_m)) {
    found.push_back(fmt::format(
        "world.route_m: leg {} passes {}, {} m beside what start_spread_m, lateral_spread_m and "
        "braking may take",
        spot->leg + 1, to_text(*spot), kClearance_m));
  }
}

void check_drawing(const Scenario& scenario, std::vector<std::string>& found) {
  const DriveParams& drive = scenario.drive;
  found = violations(scenario.world);
  if (!found.empty()) return;
  const std::size_t least = drive.stays ? 1 : 2;
  if (scenario.world.route_m.size() < least) {
    found.push_back(fmt::format("world.route_m = {} points: expected at least {}",
                                scenario.world.route_m.size(), least));
    return;
  }
  check_room(scenario, found);
  if (scenario.draw.length_spread != 0 || scenario.draw.alpha_spread_deg != 0) {
    found.push_back(
        fmt::format("draw.{}: expected 0 in a world that is drawn wall by wall",
                    scenario.draw.length_spread != 0 ? "length_spread" : "alpha_spread_deg"));
  }
  double length_m = 0;
  for (std::size_t i = 0; i + 1 < scenario.world.route_m.size(); ++i) {
    length_m += (scenario.world.route_m[i + 1] - scenario.world.route_m[i]).norm() -
                2 * (drive.lateral_spread_m + drive.waypoint_reach_m);
  }
  check_slips(scenario, length_m, found);
  check_people(scenario, scenario.world, found);
}

}  // namespace

std::vector<std::string> violations(const Scenario& scenario) {
  std::vector<std::string> found;
  if (scenario.world.corridor) found = violations(*scenario.world.corridor);
  append("lidar", scenario.lidar, found);
  append("wheels", scenario.wheels, found);
  append("imu", scenario.imu, found);
  append("drive", scenario.drive, found);
  append("slip", scenario.slip, found);
  append("outages", scenario.outages, found);
  append("draw", scenario.draw, found);
  append("people", scenario.people, found);
  if (scenario.name.empty()) found.push_back("name = \"\": expected a name");
  if (!found.empty()) return found;

  check_rate("lidar.rate_hz", scenario.lidar.rate_hz, scenario.imu.rate_hz, found);
  check_rate("wheels.rate_hz", scenario.wheels.rate_hz, scenario.imu.rate_hz, found);
  if (scenario.drive.stays && scenario.drive.stand_s == 0 && scenario.drive.spin_turns == 0) {
    found.emplace_back("drive.stays = true: expected stand_s or spin_turns beside it");
  }
  if (scenario.world.corridor) {
    check_corridor(scenario, found);
  } else {
    check_drawing(scenario, found);
  }
  return found;
}

}  // namespace corridor::simulation
