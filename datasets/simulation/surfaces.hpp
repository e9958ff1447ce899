// What a world is made of: straight walls and arcs, and how a LiDAR sees their material.
#pragma once

#include <Eigen/Core>
#include <numbers>
#include <optional>
#include <string>

namespace corridor::simulation {

// A straight wall from a to b, seen from both sides.
struct Segment {
  Eigen::Vector2d a_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d b_m = Eigen::Vector2d::Zero();

  [[nodiscard]] double length_m() const { return (b_m - a_m).norm(); }
  // Unit vector square to the wall, to the left of a -> b.
  [[nodiscard]] Eigen::Vector2d normal() const;
};

// A part of a circle, seen from both sides: from the angle begin_rad counter-clockwise over
// sweep_rad in (0, 2 pi].
struct Arc {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double radius_m = 1;
  double begin_rad = 0;
  double sweep_rad = 2 * std::numbers::pi;

  [[nodiscard]] double length_m() const { return radius_m * sweep_rad; }
  // Point at a share in [0, 1] of the length.
  [[nodiscard]] Eigen::Vector2d point_m(double share) const;
};

struct Material {
  std::string name = "wall";
  double range_factor = 1;  // of the LiDAR's maximum range from which it still returns: dark < 1
  // A beam returns only within this angle to the surface's normal and goes through beyond it, as
  // through glass, which shines back when met squarely; 90 = always.
  double seen_within_deg = 90;

  bool operator==(const Material&) const = default;
};

// Distance along the ray origin + t * unit_direction to the surface, if it meets it at t > min_m. A
// ray parallel to a wall misses it; an arc is met from inside and from outside.
std::optional<double> distance_to_m(const Segment& wall, const Eigen::Vector2d& origin_m,
                                    const Eigen::Vector2d& unit_direction, double min_m = 0);
std::optional<double> distance_to_m(const Arc& arc, const Eigen::Vector2d& origin_m,
                                    const Eigen::Vector2d& unit_direction, double min_m = 0);

// From a point to the nearest point of the surface.
double clearance_m(const Segment& wall, const Eigen::Vector2d& point_m);
double clearance_m(const Arc& arc, const Eigen::Vector2d& point_m);

}  // namespace corridor::simulation
