#include "datasets/simulation/corridor_shape.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "slam/core/expect.hpp"
#include "slam/core/units.hpp"

namespace corridor::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kMinAlpha_rad = std::numbers::pi / 6;
constexpr double kMaxAlpha_rad = 5 * std::numbers::pi / 6;
// With doors every metre and a half, a longer corridor is more walls than memory holds.
constexpr double kLargest_m = 1e4;
// Recesses keep this far from the ends of their wall, so that two of them never meet at a corner.
constexpr double kDoorMargin_m = 0.5;

// From a corner of the two outer walls along either of them to where the inner corner projects.
double corner_setback_m(const CorridorShape& shape) {
  return shape.c_m * (1 + std::cos(shape.alpha_rad)) / std::sin(shape.alpha_rad);
}

void append_recess(const Segment& wall, double centre_m, std::vector<Vector2d>& corners_m) {
  const Vector2d along = (wall.b_m - wall.a_m).normalized();
  const Vector2d outward(along.y(), -along.x());  // the corridor lies to the left of each wall
  const Vector2d begin_m = wall.a_m + (centre_m - kDoorWidth_m / 2) * along;
  const Vector2d end_m = wall.a_m + (centre_m + kDoorWidth_m / 2) * along;
  corners_m.push_back(begin_m);
  corners_m.emplace_back(begin_m + kDoorDepth_m * outward);
  corners_m.emplace_back(end_m + kDoorDepth_m * outward);
  corners_m.push_back(end_m);
}

// Adds the wall with recesses centred at first_m, first_m + every_m, ... from its beginning.
void append_wall(const Segment& wall, double first_m, double every_m, std::vector<Segment>& walls) {
  std::vector<Vector2d> corners_m{wall.a_m};
  if (every_m > 0) {
    const double margin_m = kDoorMargin_m + kDoorWidth_m / 2;
    for (double centre_m = first_m; centre_m <= wall.length_m() - margin_m; centre_m += every_m) {
      if (centre_m >= margin_m) append_recess(wall, centre_m, corners_m);
    }
  }
  corners_m.push_back(wall.b_m);
  for (std::size_t i = 1; i < corners_m.size(); ++i) {
    walls.push_back({corners_m[i - 1], corners_m[i]});
  }
}

}  // namespace

std::vector<std::string> violations(const CorridorShape& shape) {
  std::vector<std::string> found;
  const auto check_positive = [&](const char* key, double value) {
    if (!(value > 0 && value <= kLargest_m)) {
      found.push_back(
          fmt::format("world.{} = {}: expected more than 0, at most {}", key, value, kLargest_m));
    }
  };
  check_positive("a_m", shape.a_m);
  check_positive("b_m", shape.b_m);
  check_positive("c_m", shape.c_m);
  if (!(shape.alpha_rad >= kMinAlpha_rad && shape.alpha_rad <= kMaxAlpha_rad)) {
    found.push_back(
        fmt::format("world.alpha_deg = {:.6g}: expected 30 to 150", shape.alpha_rad * kDegPerRad));
  }
  if (!(shape.doors_every_m == 0 || (std::isfinite(shape.doors_every_m) &&
                                     shape.doors_every_m >= kDoorWidth_m + kDoorMargin_m))) {
    found.push_back(fmt::format("world.doors_every_m = {}: expected 0 (no doors) or at least {}",
                                shape.doors_every_m, kDoorWidth_m + kDoorMargin_m));
  }
  if (!found.empty()) return found;
  const double setback_m = corner_setback_m(shape);
  if (shape.a_m <= setback_m) {
    found.push_back(fmt::format("world.a_m = {}: expected more than {:.6g}, where the arms part",
                                shape.a_m, setback_m));
  }
  if (shape.b_m <= setback_m) {
    found.push_back(fmt::format("world.b_m = {}: expected more than {:.6g}, where the arms part",
                                shape.b_m, setback_m));
  }
  return found;
}

KeyWalls key_walls(const CorridorShape& shape) {
  CORRIDOR_EXPECT(violations(shape).empty());
  const Vector2d up(-std::cos(shape.alpha_rad), std::sin(shape.alpha_rad));  // along the second arm
  const Vector2d inward(-up.y(), up.x());
  const Vector2d outer_corner_m(shape.b_m, 0);
  const Vector2d outer_top_m = outer_corner_m + shape.a_m * up;
  const Vector2d inner_top_m = outer_top_m + shape.c_m * inward;
  const Vector2d inner_corner_m =
      outer_corner_m + shape.c_m * inward + corner_setback_m(shape) * up;
  const Vector2d inner_left_m(0, shape.c_m);
  return {.lower_outer = {Vector2d::Zero(), outer_corner_m},
          .right_outer = {outer_corner_m, outer_top_m},
          .left_end = {inner_left_m, Vector2d::Zero()},
          .top_end = {outer_top_m, inner_top_m},
          .lower_inner = {inner_corner_m, inner_left_m},
          .right_inner = {inner_top_m, inner_corner_m}};
}

std::vector<Segment> corridor_walls(const CorridorShape& shape) {
  const KeyWalls key = key_walls(shape);
  const double every_m = shape.doors_every_m;
  std::vector<Segment> walls;
  append_wall(key.lower_outer, every_m / 2, every_m, walls);
  append_wall(key.right_outer, every_m / 2, every_m, walls);
  append_wall(key.top_end, 0, 0, walls);
  append_wall(key.right_inner, every_m, every_m, walls);
  append_wall(key.lower_inner, every_m, every_m, walls);
  append_wall(key.left_end, 0, 0, walls);
  return walls;
}

}  // namespace corridor::simulation
