// What one case left on the disk, in one frame: true and estimated trajectory, map, walls.
// A file that is not there is no error (a system may end before it has a map); one that cannot be
// read is reported in `problems` and shown as missing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/simulation/world.hpp"
#include "reports/cases.hpp"
#include "reports/figures/scale.hpp"
#include "reports/figures/svg.hpp"
#include "slam/core/grid_map.hpp"
#include "slam/core/trajectory.hpp"

namespace corridor::figures {

struct Scene {
  std::optional<Trajectory> truth;     // T_world_base
  std::optional<Trajectory> estimate;  // T_map_base, at the end of the run
  std::optional<GridMap> map;          // in the map frame
  bool is_map_rendered = false;        // the system has no map: the common mapper\'s stands in
  std::optional<simulation::World> world;
  // First poses aligned, as in the position error; identity without truth.
  Pose2 T_world_map;
};

Scene load_scene(const reports::Case& entry, std::vector<std::string>& problems);

// Positions of a trajectory, moved by T.
std::vector<Eigen::Vector2d> positions_m(const Trajectory& trajectory, const Pose2& T);

// A polyline of the plane; points closer than half a pixel to the one before are left out.
void draw_path(Svg& svg, const PlaneFrame& frame, const std::vector<Eigen::Vector2d>& points_m,
               std::string_view classes);
// Grows the bounds by every wall.
void include(const simulation::World& world, Bounds& bounds);
void draw_walls(Svg& svg, const PlaneFrame& frame, const simulation::World& world,
                std::string_view classes);
// A bar of a round length that is about a fifth of the width, with its length, at the lower left.
void draw_scale_bar(Svg& svg, const PlaneFrame& frame, double x_px, double y_px, double width_px);
// The observed part of the map: occupied black, free white, unknown transparent. Where a cell is
// smaller than a pixel, a pixel is black if any cell in it is, so that thin walls stay. False (and
// nothing is drawn) for a map without an observed cell.
bool draw_map(Svg& svg, const PlaneFrame& frame, const GridMap& map, const Pose2& T_world_map);
// Where the occupied cells lie in the world, without the outermost hundredth on each side: single
// beams that leave through a window do not decide the frame.
Bounds occupied_bounds(const GridMap& map, const Pose2& T_world_map);

}  // namespace corridor::figures
