// The way through a world, without anything drawn, and the room between a way and the walls beside
// it. It does not know what moves along the way.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "datasets/simulation/scenario_params.hpp"
#include "datasets/simulation/world.hpp"

namespace corridor::simulation {

// The centre lines of the corridor's two arms, from and to params.end_margin_m before their ends; a
// drawn world's own route.
std::vector<Eigen::Vector2d> route_of(const World& world, const DriveParams& params);

// Where a way comes too near to a wall.
struct TightSpot {
  std::size_t leg = 0;  // from points_m[leg] to points_m[leg + 1]
  Eigen::Vector2d point_m = Eigen::Vector2d::Zero();
  double room_m = 0;  // from the point to the nearest wall
  double needed_m = 0;
};

// The tightest spot of the first leg that lacks room; nullopt = there is room everywhere. needed_m
// is the room wanted at each point; from one point to the next it goes evenly from the one to the
// other. A single point is a leg of its own. Tried every 5 cm.
std::optional<TightSpot> tight_spot(const World& world,
                                    const std::vector<Eigen::Vector2d>& points_m,
                                    const std::vector<double>& needed_m);

// "0.31 m from a wall at (3.2, 1.0); expected at least 0.50 m"; rounded apart, never to the same.
std::string to_text(const TightSpot& spot);

// True where a wall reaches into the strip of this half width along the route. Its ends are square.
// Gives the number of the leg.
std::optional<std::size_t> blocked_leg(const World& world,
                                       const std::vector<Eigen::Vector2d>& route_m,
                                       double half_width_m);

}  // namespace corridor::simulation
