#include "datasets/simulation/surfaces.hpp"

#include <algorithm>
#include <cmath>

namespace corridor::simulation {
namespace {

using Eigen::Vector2d;

// Surfaces are longer by this at both ends, so that no ray slips through a corner by rounding.
constexpr double kEndOverlap_m = 1e-9;
// Rays whose direction differs less from the wall's [rad] count as parallel.
constexpr double kParallel = 1e-12;

double cross(const Vector2d& u, const Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

bool is_on(const Arc& arc, const Vector2d& from_centre_m) {
  constexpr double kTurn_rad = 2 * std::numbers::pi;
  const double overlap_rad = kEndOverlap_m / arc.radius_m;
  double angle_rad = std::atan2(from_centre_m.y(), from_centre_m.x()) - arc.begin_rad + overlap_rad;
  angle_rad -= kTurn_rad * std::floor(angle_rad / kTurn_rad);
  return angle_rad <= arc.sweep_rad + 2 * overlap_rad;
}

}  // namespace

Vector2d Segment::normal() const {
  const Vector2d along = (b_m - a_m).normalized();
  return {-along.y(), along.x()};
}

Vector2d Arc::point_m(double share) const {
  const double angle_rad = begin_rad + share * sweep_rad;
  return centre_m + radius_m * Vector2d(std::cos(angle_rad), std::sin(angle_rad));
}

std::optional<double> distance_to_m(const Segment& wall, const Vector2d& origin_m,
                                    const Vector2d& unit_direction, double min_m) {
  const Vector2d along = wall.b_m - wall.a_m;
  const double length_m = along.norm();
  const double sine_m = cross(unit_direction, along);
  if (std::abs(sine_m) <= kParallel * length_m) return std::nullopt;
  const Vector2d to_wall = wall.a_m - origin_m;
  const double along_ratio = cross(to_wall, unit_direction) / sine_m;
  const double overlap_ratio = kEndOverlap_m / length_m;
  if (along_ratio < -overlap_ratio || along_ratio > 1 + overlap_ratio) return std::nullopt;
  const double range_m = cross(to_wall, along) / sine_m;
  if (range_m <= min_m) return std::nullopt;
  return range_m;
}

std::optional<double> distance_to_m(const Arc& arc, const Vector2d& origin_m,
                                    const Vector2d& unit_direction, double min_m) {
  const Vector2d to_centre = arc.centre_m - origin_m;
  const double middle_m = to_centre.dot(unit_direction);
  // The ray's distance from the centre by the cross product: exact far away, where the difference
  // of squares is not.
  const double offset_m = cross(unit_direction, to_centre);
  const double half_square_m2 = (arc.radius_m - offset_m) * (arc.radius_m + offset_m);
  if (half_square_m2 < 0) return std::nullopt;
  const double half_m = std::sqrt(half_square_m2);
  for (const double range_m : {middle_m - half_m, middle_m + half_m}) {
    if (range_m > min_m && is_on(arc, range_m * unit_direction - to_centre)) return range_m;
  }
  return std::nullopt;
}

double clearance_m(const Segment& wall, const Vector2d& point_m) {
  const Vector2d along = wall.b_m - wall.a_m;
  const double share = std::clamp((point_m - wall.a_m).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (wall.a_m + share * along - point_m).norm();
}

double clearance_m(const Arc& arc, const Vector2d& point_m) {
  const Vector2d from_centre = point_m - arc.centre_m;
  if (is_on(arc, from_centre)) return std::abs(from_centre.norm() - arc.radius_m);
  return std::min((arc.point_m(0) - point_m).norm(), (arc.point_m(1) - point_m).norm());
}

}  // namespace corridor::simulation
