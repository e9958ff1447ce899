// The L-shaped corridor of the paper with its key lengths a, b, c and angle alpha.
#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "datasets/simulation/surfaces.hpp"

namespace corridor::simulation {

// The L: a first arm along +x of the world and a second arm that turns left at its end.
//
//            top_end                 lower_outer  from (0, 0) to (b, 0)
//          ┌────┐                    right_outer  from (b, 0), a long, at the interior angle alpha
//  right_  │    │ right_outer        left_end     from (0, 0) to (0, c), at x = 0
//  inner   │    │                    top_end      square to right_outer, c long
//  ┌───────┘    │                    lower_inner  parallel to lower_outer at distance c
//  │lower_inner │                    right_inner  parallel to right_outer at distance c
//  └────────────┘ lower_outer
//
// doors_every_m > 0 cuts recesses kDoorDepth_m deep and kDoorWidth_m wide into the four long walls,
// away from the corridor, one per period, those of the inner walls half a period later.
struct CorridorShape {
  double a_m = 14.5;                        // length of the right outer wall
  double b_m = 21.0;                        // length of the lower outer wall
  double c_m = 5.0;                         // width of both arms
  double alpha_rad = std::numbers::pi / 2;  // interior angle between the two outer walls
  double doors_every_m = 0;                 // period of the door recesses; 0 = no doors

  bool operator==(const CorridorShape&) const = default;
};

inline constexpr double kDoorDepth_m = 0.12;
inline constexpr double kDoorWidth_m = 1.0;

// The six walls without their doors; each runs counter-clockwise around the corridor.
struct KeyWalls {
  Segment lower_outer, right_outer, left_end, top_end, lower_inner, right_inner;
};

// All rules broken ("world.c_m = 30: expected less than ..."); empty = the corridor can be drawn.
std::vector<std::string> violations(const CorridorShape& shape);

// Both require violations(shape).empty().
KeyWalls key_walls(const CorridorShape& shape);
// The walls with their doors, counter-clockwise around the corridor.
std::vector<Segment> corridor_walls(const CorridorShape& shape);

}  // namespace corridor::simulation
