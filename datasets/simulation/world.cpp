#include "datasets/simulation/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "slam/core/expect.hpp"
#include "slam/core/units.hpp"

namespace corridor::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kLargest_m = 1e5;
constexpr double kShortest_m = 1e-3;
constexpr double kArcPiece_rad = std::numbers::pi / 36;
// The walls beside a longer one would be looked for for hours.
constexpr double kLongestRoute_m = 1e4;

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

bool is_sane(const Vector2d& point_m) {
  return point_m.allFinite() && point_m.lpNorm<Eigen::Infinity>() <= kLargest_m;
}

void check_surfaces(const World& world, std::vector<std::string>& found) {
  if (world.num_surfaces() == 0) found.emplace_back("world: no walls; expected at least one");
  for (std::size_t i = 0; i < world.walls.size(); ++i) {
    const Segment& wall = world.walls[i];
    if (!is_sane(wall.a_m) || !is_sane(wall.b_m) || wall.length_m() < kShortest_m) {
      found.push_back(fmt::format(
          "world: wall {} from ({}, {}) to ({}, {}) m; expected at least {} m of length within {} "
          "m "
          "of the origin",
          i, wall.a_m.x(), wall.a_m.y(), wall.b_m.x(), wall.b_m.y(), kShortest_m, kLargest_m));
    }
  }
  for (std::size_t i = 0; i < world.arcs.size(); ++i) {
    const Arc& arc = world.arcs[i];
    const bool is_fit = is_sane(arc.centre_m) && arc.radius_m >= kShortest_m &&
                        arc.radius_m <= kLargest_m && std::isfinite(arc.begin_rad) &&
                        arc.sweep_rad > 0 && arc.sweep_rad <= 2 * std::numbers::pi + 1e-12;
    if (!is_fit) {
      found.push_back(fmt::format(
          "world: arc {} with radius {} m and sweep {} deg; expected {} to {} m and 0 to 360 deg",
          i, arc.radius_m, arc.sweep_rad * kDegPerRad, kShortest_m, kLargest_m));
    }
  }
}

void check_materials(const World& world, std::vector<std::string>& found) {
  std::set<std::string> names;
  for (const Material& material : world.materials) {
    // Surfaces name their material, and the name is written into quotes.
    if (material.name.empty() || material.name.find_first_of("\"\\") != std::string::npos ||
        std::any_of(material.name.begin(), material.name.end(), is_control) ||
        !names.insert(material.name).second) {
      found.push_back(
          fmt::format("world: material \"{}\"; expected a name that no other has, without quotes",
                      material.name));
    }
    if (!(material.range_factor > 0 && material.range_factor <= 1)) {
      found.push_back(fmt::format("world: material {} has range_factor = {}; expected (0, 1]",
                                  material.name, material.range_factor));
    }
    if (!(material.seen_within_deg > 0 && material.seen_within_deg <= 90)) {
      found.push_back(fmt::format("world: material {} has seen_within_deg = {}; expected (0, 90]",
                                  material.name, material.seen_within_deg));
    }
  }
}

void check_route(const std::vector<Vector2d>& route_m, std::vector<std::string>& found) {
  double length_m = 0;
  for (std::size_t i = 0; i < route_m.size(); ++i) {
    if (!is_sane(route_m[i])) {
      found.push_back(
          fmt::format("world.route_m: point {} is ({:.4g}, {:.4g}) m; expected within {} "
                      "m of the origin",
                      i + 1, route_m[i].x(), route_m[i].y(), kLargest_m));
      return;
    }
    if (i == 0) continue;
    const double leg_m = (route_m[i] - route_m[i - 1]).norm();
    if (leg_m < kShortest_m) {
      found.push_back(
          fmt::format("world.route_m: points {} and {} are both ({:.4g}, {:.4g}) m; expected at "
                      "least {} m of way "
                      "between them",
                      i, i + 1, route_m[i].x(), route_m[i].y(), kShortest_m));
      return;
    }
    length_m += leg_m;
    if (length_m > kLongestRoute_m) {
      found.push_back(fmt::format("world.route_m: {:.0f} m up to point {}; expected at most {} m",
                                  length_m, i + 1, kLongestRoute_m));
      return;
    }
  }
}

}  // namespace

const Material& World::material(std::size_t surface_index) const {
  static const Material kPlain;
  CORRIDOR_EXPECT(surface_index < num_surfaces());
  return materials.empty() ? kPlain : materials[material_of_surface[surface_index]];
}

Vector2d World::normal(std::size_t surface_index, const Vector2d& point_m) const {
  CORRIDOR_EXPECT(surface_index < num_surfaces());
  if (surface_index < walls.size()) return walls[surface_index].normal();
  return (point_m - arcs[surface_index - walls.size()].centre_m).normalized();
}

std::vector<std::vector<Vector2d>> outlines_m(const World& world) {
  std::vector<std::vector<Vector2d>> lines;
  for (const Segment& wall : world.walls) lines.push_back({wall.a_m, wall.b_m});
  for (const Arc& arc : world.arcs) {
    const int num_pieces = std::max(1, static_cast<int>(std::ceil(arc.sweep_rad / kArcPiece_rad)));
    std::vector<Vector2d>& line = lines.emplace_back();
    for (int i = 0; i <= num_pieces; ++i) {
      line.push_back(arc.point_m(static_cast<double>(i) / num_pieces));
    }
  }
  return lines;
}

World make_corridor(const CorridorShape& shape) {
  World world;
  world.walls = corridor_walls(shape);
  world.corridor = shape;
  return world;
}

std::vector<std::string> violations(const World& world) {
  if (world.corridor) return violations(*world.corridor);
  std::vector<std::string> found;
  check_surfaces(world, found);
  check_materials(world, found);
  check_route(world.route_m, found);
  return found;
}

}  // namespace corridor::simulation
