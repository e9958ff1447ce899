#include "bench/metrics/key_distances.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/metrics/wall_survey.hpp"
#include "slam/core/units.hpp"

namespace corridor::metrics {
namespace {

// Below this sine two lines do not cross anywhere near.
constexpr double kMinCrossingSine = 0.1;
// Steps of the numerical derivatives: quantities are nearly linear in both over such steps.
constexpr double kStep_m = 1e-4;
constexpr double kStep_rad = 1e-5;

using MeasuredLine = tl::expected<MeasuredWall, std::string>;
// NaN where the lines do not define it; never leaves this file.
using Quantity = std::function<double(std::span<const MeasuredWall>)>;

Eigen::Vector2d direction(const MeasuredWall& wall) {
  return {std::cos(wall.direction_rad), std::sin(wall.direction_rad)};
}

Eigen::Vector2d left_normal(const MeasuredWall& wall) {
  return {-std::sin(wall.direction_rad), std::cos(wall.direction_rad)};
}

// Along `wall`, from its point to where `other` crosses it [m].
double crossing_along_m(const MeasuredWall& wall, const MeasuredWall& other) {
  const Eigen::Vector2d normal = left_normal(other);
  const double sine = normal.dot(direction(wall));
  if (std::abs(sine) < kMinCrossingSine) return std::nan("");
  return normal.dot(other.point_map_m - wall.point_map_m) / sine;
}

// Walls: the one measured along, its begin, its end.
double length_between_crossings_m(std::span<const MeasuredWall> walls) {
  return crossing_along_m(walls[0], walls[2]) - crossing_along_m(walls[0], walls[1]);
}

// Walls: two that face each other and run in opposite senses.
double width_m(std::span<const MeasuredWall> walls) {
  const MeasuredWall& wall = walls[0];
  const MeasuredWall& facing = walls[1];
  const Eigen::Vector2d along = direction(wall);
  const double shift_m = along.dot(facing.point_map_m - wall.point_map_m);
  // The facing wall runs backwards along this one, so its begin and end change places.
  const double begin_m = std::max(wall.begin_m, shift_m - facing.end_m);
  const double end_m = std::min(wall.end_m, shift_m - facing.begin_m);
  if (!(end_m > begin_m)) return std::nan("");
  const Eigen::Vector2d middle_map_m = wall.point_map_m + 0.5 * (begin_m + end_m) * along;
  const Eigen::Vector2d across = (left_normal(wall) - left_normal(facing)).normalized();
  const double cosine = left_normal(facing).dot(across);
  if (std::abs(cosine) < kMinCrossingSine) return std::nan("");
  return left_normal(facing).dot(facing.point_map_m - middle_map_m) / cosine;
}

// Walls: lower_outer and right_outer, which follow each other counter-clockwise.
double interior_angle_rad(std::span<const MeasuredWall> walls) {
  const Eigen::Vector2d back = -direction(walls[0]);
  const Eigen::Vector2d ahead = direction(walls[1]);
  return std::atan2(std::abs(ahead.x() * back.y() - ahead.y() * back.x()), ahead.dot(back));
}

struct Measurement {
  double value = 0;
  double sigma = 0;
};

// Value and standard deviation by first-order propagation; the walls' errors are taken as
// independent.
tl::expected<Measurement, std::string> measure(const std::vector<MeasuredLine>& lines,
                                               const std::vector<std::string>& names,
                                               const Quantity& quantity) {
  std::vector<MeasuredWall> walls;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!lines[i])
      return tl::make_unexpected("not measurable: " + names[i] + ": " + lines[i].error());
    walls.push_back(*lines[i]);
  }
  const double value = quantity(walls);
  double variance = 0;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    auto moved = walls;
    moved[i].point_map_m += kStep_m * left_normal(walls[i]);
    variance += std::pow((quantity(moved) - value) / kStep_m * walls[i].offset_sigma_m, 2);
    moved = walls;
    moved[i].direction_rad += kStep_rad;
    variance += std::pow((quantity(moved) - value) / kStep_rad * walls[i].direction_sigma_rad, 2);
  }
  if (!std::isfinite(value) || !std::isfinite(variance)) {
    return tl::make_unexpected(
        std::string("not measurable: the lines do not meet as in a corridor"));
  }
  return Measurement{value, std::sqrt(variance)};
}

results::KeyDistance as_distance(double true_m,
                                 const tl::expected<Measurement, std::string>& measured) {
  results::KeyDistance distance;
  distance.true_m = true_m;
  distance.status = measured ? "ok" : measured.error();
  if (!measured) return distance;
  distance.measured_m = measured->value;
  distance.error_m = measured->value - true_m;
  distance.sigma_m = measured->sigma;
  return distance;
}

results::KeyAngle as_angle(double true_rad,
                           const tl::expected<Measurement, std::string>& measured) {
  results::KeyAngle angle;
  angle.true_deg = true_rad * kDegPerRad;
  angle.status = measured ? "ok" : measured.error();
  if (!measured) return angle;
  angle.measured_deg = measured->value * kDegPerRad;
  angle.error_deg = (measured->value - true_rad) * kDegPerRad;
  angle.sigma_deg = measured->sigma * kDegPerRad;
  return angle;
}

results::KeyDistances without_corridor() {
  results::KeyDistances distances;
  for (auto* distance : {&distances.a, &distances.b, &distances.c}) {
    distance->status = "the world has no corridor";
  }
  distances.alpha.status = distances.a.status;
  return distances;
}

}  // namespace

results::KeyDistances measure_key_distances(const GridMap& map, const Trajectory& estimate,
                                            const Trajectory& truth_world,
                                            const simulation::World& world, double lidar_range_m) {
  if (!world.corridor) return without_corridor();
  const simulation::CorridorShape& shape = *world.corridor;
  const simulation::KeyWalls key = simulation::key_walls(shape);
  // Where an arm, c wide, ends on the outer wall of the other one.
  const double arm_m = shape.c_m / std::sin(shape.alpha_rad);
  const double b_m = key.lower_outer.length_m();
  const WallSurvey survey(map, estimate, truth_world, world, lidar_range_m);

  const auto lower = survey.measure(whole(key.lower_outer));
  const auto right = survey.measure(whole(key.right_outer));
  const auto left_end = survey.measure(whole(key.left_end));
  const auto top_end = survey.measure(whole(key.top_end));
  const auto lower_inner = survey.measure(whole(key.lower_inner));
  const auto lower_facing = survey.measure({key.lower_outer, 0, key.lower_inner.length_m()});
  const auto lower_closing = survey.measure({key.lower_outer, b_m - arm_m, b_m});
  const auto right_closing = survey.measure({key.right_outer, 0, arm_m});

  results::KeyDistances distances;
  distances.a = as_distance(
      shape.a_m, measure({right, lower_closing, top_end}, {"right_outer", "lower_outer", "top_end"},
                         length_between_crossings_m));
  distances.b = as_distance(
      shape.b_m, measure({lower, left_end, right_closing},
                         {"lower_outer", "left_end", "right_outer"}, length_between_crossings_m));
  distances.c = as_distance(
      shape.c_m, measure({lower_facing, lower_inner}, {"lower_outer", "lower_inner"}, width_m));
  distances.alpha = as_angle(
      shape.alpha_rad, measure({lower, right}, {"lower_outer", "right_outer"}, interior_angle_rad));
  return distances;
}

}  // namespace corridor::metrics
