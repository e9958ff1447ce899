#include "datasets/simulation/route.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "slam/core/expect.hpp"

namespace corridor::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kStep_m = 0.05;
constexpr double kCentimetres = 100;  // per metre, for rounding

double room_at(const World& world, const Vector2d& point_m) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Segment& wall : world.walls) {
    nearest_m = std::min(nearest_m, clearance_m(wall, point_m));
  }
  for (const Arc& arc : world.arcs) nearest_m = std::min(nearest_m, clearance_m(arc, point_m));
  return nearest_m;
}

// Liang and Barsky: does the segment pass through the box [0, length] x [-half_width, half_width]?
bool meets_box(const Vector2d& a_m, const Vector2d& b_m, double length_m, double half_width_m) {
  double begin = 0, end = 1;
  const auto clip = [&](double from, double to, double low, double high) {
    const double change = to - from;
    if (change == 0) return from > low && from < high;
    const double first = (low - from) / change, second = (high - from) / change;
    begin = std::max(begin, std::min(first, second));
    end = std::min(end, std::max(first, second));
    return begin < end;
  };
  return clip(a_m.x(), b_m.x(), 0, length_m) && clip(a_m.y(), b_m.y(), -half_width_m, half_width_m);
}

}  // namespace

std::vector<Vector2d> route_of(const World& world, const DriveParams& params) {
  if (!world.corridor) return world.route_m;
  const KeyWalls key = key_walls(*world.corridor);
  const Vector2d top_m = (key.top_end.a_m + key.top_end.b_m) / 2;
  const Vector2d up = (key.right_outer.b_m - key.right_outer.a_m).normalized();
  const Vector2d corner_m = (key.right_outer.a_m + key.right_inner.b_m) / 2;
  return {
      {params.end_margin_m, world.corridor->c_m / 2}, corner_m, top_m - params.end_margin_m * up};
}

std::optional<TightSpot> tight_spot(const World& world, const std::vector<Vector2d>& points_m,
                                    const std::vector<double>& needed_m) {
  CORRIDOR_EXPECT(points_m.size() == needed_m.size());
  const std::size_t num_points = points_m.size();
  double spare_m = 0;  // at least so much room is to spare here: walls need no new look
  for (std::size_t leg = 0; leg < num_points && (leg == 0 || leg + 1 < num_points); ++leg) {
    const std::size_t next = std::min(leg + 1, num_points - 1);
    const Vector2d way_m = points_m[next] - points_m[leg];
    const double growth_m = needed_m[next] - needed_m[leg];
    const int num_steps = std::max(1, static_cast<int>(std::ceil(way_m.norm() / kStep_m)));
    std::optional<TightSpot> tightest;
    for (int k = 0; k <= num_steps; ++k) {
      if (k > 0) spare_m -= (way_m.norm() + std::abs(growth_m)) / num_steps;
      if (spare_m > 0) continue;
      const double share = static_cast<double>(k) / num_steps;
      TightSpot spot{leg, points_m[leg] + share * way_m, 0, needed_m[leg] + share * growth_m};
      spot.room_m = room_at(world, spot.point_m);
      spare_m = spot.room_m - spot.needed_m;
      const bool is_tightest = !tightest || spare_m < tightest->room_m - tightest->needed_m;
      if (spare_m < 0 && is_tightest) tightest = spot;
    }
    if (tightest) return tightest;
  }
  return std::nullopt;
}

std::string to_text(const TightSpot& spot) {
  return fmt::format("{:.2f} m from a wall at ({:.4g}, {:.4g}); expected at least {:.2f} m",
                     std::floor(spot.room_m * kCentimetres) / kCentimetres, spot.point_m.x(),
                     spot.point_m.y(), std::ceil(spot.needed_m * kCentimetres) / kCentimetres);
}

std::optional<std::size_t> blocked_leg(const World& world, const std::vector<Vector2d>& route_m,
                                       double half_width_m) {
  const std::vector<std::vector<Vector2d>> lines_m = outlines_m(world);
  for (std::size_t leg = 0; leg + 1 < route_m.size(); ++leg) {
    const Vector2d way_m = route_m[leg + 1] - route_m[leg];
    const Vector2d along = way_m.normalized();
    const auto in_leg = [&](const Vector2d& point_m) {
      const Vector2d from_m = point_m - route_m[leg];
      return Vector2d(along.dot(from_m), along.x() * from_m.y() - along.y() * from_m.x());
    };
    for (const std::vector<Vector2d>& line_m : lines_m) {
      for (std::size_t i = 0; i + 1 < line_m.size(); ++i) {
        if (meets_box(in_leg(line_m[i]), in_leg(line_m[i + 1]), way_m.norm(), half_width_m)) {
          return leg;
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace corridor::simulation
