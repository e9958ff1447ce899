// The world a simulated robot drives in: walls and arcs of stated materials, and a route through
// them. Drawn in TOML, made from the paper's corridor, or traced from an occupancy map. It does not
// know sensors or robots.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "datasets/simulation/corridor_shape.hpp"
#include "datasets/simulation/surfaces.hpp"
#include "slam/core/grid_map.hpp"
#include "slam/core/result.hpp"

namespace corridor::simulation {

// Surfaces are numbered: the walls first, then the arcs.
struct World {
  std::vector<Segment> walls;
  std::vector<Arc> arcs;
  std::vector<Material> materials;  // empty: everything is Material{}
  // Per surface, into `materials`; empty where `materials` is.
  std::vector<std::uint8_t> material_of_surface;
  // Where a robot drives, in order; empty for the paper's corridor, whose route is drawn.
  std::vector<Eigen::Vector2d> route_m;
  std::optional<CorridorShape> corridor;  // where the walls are those of make_corridor()

  [[nodiscard]] std::size_t num_surfaces() const { return walls.size() + arcs.size(); }
  [[nodiscard]] const Material& material(std::size_t surface_index) const;
  // Unit normal of a surface at a point on it.
  [[nodiscard]] Eigen::Vector2d normal(std::size_t surface_index,
                                       const Eigen::Vector2d& point_m) const;
};

// Every surface as a line through points, arcs in pieces of at most 5 degrees: for drawing.
std::vector<std::vector<Eigen::Vector2d>> outlines_m(const World& world);

// Requires violations(shape).empty().
World make_corridor(const CorridorShape& shape);

// Walls along the borders between occupied cells and all others, straight ones where the borders
// are the staircases of slanted walls (map_borders.hpp). No route.
World traced_world(const GridMap& map);

// Everything that makes a world unfit: surfaces without length, materials out of range, coordinates
// that are not finite or beyond 1e5 m, a route that stands still or is longer than 1e4 m. Empty =
// fit. Whether there is room along the route: route.hpp.
std::vector<std::string> violations(const World& world);

// Reads a world file, or the [world] table of a LOG.truth.toml or of a scenario; other tables are
// not looked at. Either the corridor's keys
//   a_m b_m c_m alpha_deg doors_every_m      (missing keys are errors)
// or a drawing
//   polygons  = [{points_m = [[x, y], ...], closed = true, material = "wall"}, ...]
//   arcs      = [{centre_m = [x, y], radius_m, begin_deg, sweep_deg, material}, ...]
//   materials = [{name, range_factor, seen_within_deg}, ...]
//   route_m   = [[x, y], ...]
// Unknown keys are errors.
Result<World> read_world(const std::filesystem::path& path);
// The [world] table that read_world() reads back as the same world; angles of arcs to rounding.
std::string world_toml(const World& world);

}  // namespace corridor::simulation
