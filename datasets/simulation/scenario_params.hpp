// The parameters of a scenario besides its sensors, one struct per cause. It does not read files;
// scenario.hpp does.
#pragma once

#include <string>
#include <vector>

#include "datasets/simulation/world.hpp"
#include "slam/core/params.hpp"

namespace corridor::simulation {

// The [world] table: CorridorShape as files spell it. Its defaults are those of CorridorShape.
struct WorldParams {
  double a_m, b_m, c_m, alpha_deg, doors_every_m;

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"a_m", "m", "length of the right outer wall"}, p.a_m);
    v(ParamInfo{"b_m", "m", "length of the lower outer wall"}, p.b_m);
    v(ParamInfo{"c_m", "m", "width of the corridor"}, p.c_m);
    v(ParamInfo{"alpha_deg", "deg", "interior angle between the two outer walls"}, p.alpha_deg);
    v(ParamInfo{"doors_every_m", "m", "period of the door recesses; 0 = none"}, p.doors_every_m);
  }
};
WorldParams to_params(const CorridorShape& shape);
CorridorShape to_shape(const WorldParams& params);

// The drive. In the paper's corridor: from end_margin_m before the left end along the first arm,
// around the corner, to end_margin_m before the top end; in a drawn world: along its route. First
// the robot stands for stand_s and turns spin_turns times on the spot, then it heads for one
// waypoint after the other.
struct DriveParams {
  double speed_min_mps = 0.4;
  double speed_max_mps = 0.6;
  double acceleration_mps2 = 0.5;
  double yaw_rate_max_radps = 0.8;
  double yaw_acceleration_radps2 = 4;
  double heading_gain_per_s = 1.5;
  double turn_in_place_deg = 35;
  double waypoint_reach_m = 0.2;
  double end_margin_m = 2.5;
  double start_spread_m = 0.3;
  double heading_spread_deg = 20;
  double lateral_spread_m = 0.4;
  int num_arm_waypoints = 0;
  bool is_return_trip = false;
  double stand_s = 0;
  double spin_turns = 0;
  bool stays = false;
  double friction_limit_mps2 = 0;

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"speed_min_mps", "m/s", "lower end of the drawn cruising speed", 0.01, 5},
      p.speed_min_mps);
    v(ParamInfo{"speed_max_mps", "m/s", "upper end of the drawn cruising speed", 0.01, 5},
      p.speed_max_mps);
    v(ParamInfo{"acceleration_mps2", "m/s2", "limit of acceleration and braking", 0.01, 10},
      p.acceleration_mps2);
    v(ParamInfo{"yaw_rate_max_radps", "rad/s", "limit of the yaw rate", 0.01, 10},
      p.yaw_rate_max_radps);
    v(ParamInfo{"yaw_acceleration_radps2", "rad/s2", "limit of the yaw acceleration", 0.1, 100},
      p.yaw_acceleration_radps2);
    v(ParamInfo{"heading_gain_per_s", "1/s", "commanded yaw rate per heading error", 0.1, 10},
      p.heading_gain_per_s);
    v(ParamInfo{"turn_in_place_deg", "deg", "larger heading errors make the robot stop and turn", 5,
                90},
      p.turn_in_place_deg);
    v(ParamInfo{"waypoint_reach_m", "m", "a waypoint this near counts as reached", 0.05, 1},
      p.waypoint_reach_m);
    v(ParamInfo{"end_margin_m", "m",
                "distance of the first and the last waypoint from the end walls", 1, 100},
      p.end_margin_m);
    v(ParamInfo{"start_spread_m", "m", "half range of the drawn start position, along and across",
                0, 5},
      p.start_spread_m);
    v(ParamInfo{"heading_spread_deg", "deg", "half range of the drawn start heading", 0, 180},
      p.heading_spread_deg);
    v(ParamInfo{"lateral_spread_m", "m",
                "half range of each waypoint's drawn offset across the arm", 0, 5},
      p.lateral_spread_m);
    v(ParamInfo{"num_arm_waypoints", "1", "waypoints inside each arm, evenly spaced; 0 = straight",
                0, 100},
      p.num_arm_waypoints);
    v(ParamInfo{"is_return_trip", "", "drives back to the start the same way, which closes a loop"},
      p.is_return_trip);
    v(ParamInfo{"stand_s", "s", "stands still for so long at first", 0, 3600}, p.stand_s);
    v(ParamInfo{"spin_turns", "1", "then turns so often on the spot; negative = clockwise", -1000,
                1000},
      p.spin_turns);
    v(ParamInfo{"stays", "", "the drive ends there, without a waypoint"}, p.stays);
    v(
        ParamInfo{
            "friction_limit_mps2", "m/s2",
            "the floor gives the robot no more acceleration, forward and sideways as one vector: "
            "wheels that are driven harder slip; 0 = grip without limit",
            0, 20},
        p.friction_limit_mps2);
  }
  std::vector<std::string> relations() const;
};

// Intervals in which the wheels turn (1 + ratio) times as far as the robot moves; they never
// overlap.
struct SlipParams {
  int num_slips = 0;
  double share = 0;
  double duration_s = 1;
  double ratio = 0.6;

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"num_slips", "1", "number of slips, at drawn times of the drive", 0, 1000},
      p.num_slips);
    v(ParamInfo{"share", "1", "instead: as many slips as fill this part of the drive", 0, 0.5},
      p.share);
    v(ParamInfo{"duration_s", "s", "length of each", 0.01, 100}, p.duration_s);
    v(ParamInfo{"ratio", "1", "spin of the wheels as a part of the true path", -1, 10}, p.ratio);
  }
  std::vector<std::string> relations() const;
};

// Times in which a sensor says nothing, each of the three at its own: a cable, a driver, a bus.
struct OutageParams {
  double duration_s = 0;
  double interval_s = 15;

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"duration_s", "s", "length of each; 0 = none", 0, 100}, p.duration_s);
    v(ParamInfo{"interval_s", "s",
                "mean of the drawn time from the end of one, or the log's begin, to the next", 0.1,
                1e6},
      p.interval_s);
  }
};

// People who walk up and down the route, round and opaque. They step aside for the robot.
struct PeopleParams {
  int num_people = 0;
  double radius_m = 0.22;
  double speed_min_mps = 0.7;
  double speed_max_mps = 1.4;
  double lateral_spread_m = 1.0;

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"num_people", "1", "how many", 0, 1000}, p.num_people);
    v(ParamInfo{"radius_m", "m", "of each", 0.05, 1}, p.radius_m);
    v(ParamInfo{"speed_min_mps", "m/s", "lower end of the drawn speed", 0, 3}, p.speed_min_mps);
    v(ParamInfo{"speed_max_mps", "m/s", "upper end of the drawn speed", 0, 3}, p.speed_max_mps);
    v(ParamInfo{"lateral_spread_m", "m", "half range of the drawn distance from the route", 0, 10},
      p.lateral_spread_m);
  }
  std::vector<std::string> relations() const;
};

// What else each seed draws.
struct DrawParams {
  double length_spread = 0;
  double alpha_spread_deg = 0;

  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"length_spread", "1", "half range of the drawn relative change of a, b and c", 0,
                0.5},
      p.length_spread);
    v(ParamInfo{"alpha_spread_deg", "deg", "half range of the drawn change of alpha", 0, 45},
      p.alpha_spread_deg);
  }
};

}  // namespace corridor::simulation
