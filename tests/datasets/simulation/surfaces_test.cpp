#include "datasets/simulation/surfaces.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "datasets/simulation/ray_casting.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

using Eigen::Vector2d;

constexpr double kPi = std::numbers::pi;
constexpr double kExact_m = 1e-12;

Vector2d unit(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

// Second implementation: the first sign change of (distance from the centre - radius) along the
// ray in small steps, narrowed by bisection, and the angle compared by its tangent half-plane.
std::optional<double> marched_range_m(const Arc& arc, const Vector2d& origin_m,
                                      const Vector2d& direction, double max_m) {
  const auto excess_m = [&](double range_m) {
    return (origin_m + range_m * direction - arc.centre_m).norm() - arc.radius_m;
  };
  const double step_m = 0.002;
  for (double near_m = 1e-9; near_m < max_m; near_m += step_m) {
    if ((excess_m(near_m) > 0) == (excess_m(near_m + step_m) > 0)) continue;
    double low_m = near_m, high_m = near_m + step_m;
    for (int i = 0; i < 60; ++i) {
      const double middle_m = (low_m + high_m) / 2;
      ((excess_m(middle_m) > 0) == (excess_m(low_m) > 0) ? low_m : high_m) = middle_m;
    }
    // How far the point is from the arc's middle, as seen from the centre.
    const Vector2d middle = unit(arc.begin_rad + arc.sweep_rad / 2);
    const Vector2d at = (origin_m + low_m * direction - arc.centre_m).normalized();
    const double apart_rad =
        std::abs(std::atan2(middle.x() * at.y() - middle.y() * at.x(), middle.dot(at)));
    if (apart_rad <= arc.sweep_rad / 2 + 1e-9) return low_m;
  }
  return std::nullopt;
}

TEST(Arc, IsMetAtTheDistancesThatItsRadiusGives) {
  const Arc circle{.centre_m = {5, 1}, .radius_m = 2};
  EXPECT_NEAR(*distance_to_m(circle, {0, 1}, {1, 0}), 3, kExact_m);   // from outside
  EXPECT_NEAR(*distance_to_m(circle, {5, 1}, {0, -1}), 2, kExact_m);  // from its centre
  EXPECT_NEAR(*distance_to_m(circle, {6, 1}, {-1, 0}), 3, kExact_m);  // from inside
  // Half a radius beside the centre line: 5 - sqrt(4 - 1).
  EXPECT_NEAR(*distance_to_m(circle, {0, 2}, {1, 0}), 5 - std::sqrt(3.0), kExact_m);
  EXPECT_FALSE(distance_to_m(circle, {0, 3.1}, {1, 0}));                  // past it
  EXPECT_FALSE(distance_to_m(circle, {0, 1}, {-1, 0}));                   // behind
  EXPECT_NEAR(*distance_to_m(circle, {0, 1}, {1, 0}, 3.5), 7, kExact_m);  // its far side
}

TEST(Arc, IsMetOnlyWhereItSweeps) {
  // The upper left quarter.
  const Arc quarter{.centre_m = {0, 0}, .radius_m = 2, .begin_rad = kPi / 2, .sweep_rad = kPi / 2};
  EXPECT_NEAR(*distance_to_m(quarter, {0, 0}, unit(0.75 * kPi)), 2, kExact_m);
  EXPECT_FALSE(distance_to_m(quarter, {0, 0}, unit(0.25 * kPi)));
  // Enters where there is no arc and meets it from inside.
  EXPECT_NEAR(*distance_to_m(quarter, {5, 1}, {-1, 0}), 5 + std::sqrt(3.0), kExact_m);
  // Across the branch of atan2.
  const Arc left{.centre_m = {0, 0}, .radius_m = 1, .begin_rad = kPi - 0.1, .sweep_rad = 0.2};
  EXPECT_TRUE(distance_to_m(left, {0, 0}, unit(kPi - 0.05)));
  EXPECT_TRUE(distance_to_m(left, {0, 0}, unit(kPi + 0.05)));
  EXPECT_FALSE(distance_to_m(left, {0, 0}, unit(kPi + 0.15)));
}

RC_GTEST_PROP(Arc, DistanceEqualsMarchingAlongTheRay, (std::uint64_t seed)) {
  Rng rng(seed);
  const Arc arc{.centre_m = {rng.uniform(-3, 3), rng.uniform(-3, 3)},
                .radius_m = rng.uniform(0.3, 3),
                .begin_rad = rng.uniform(-7, 7),
                .sweep_rad = rng.uniform(0.2, 2 * kPi)};
  const Vector2d origin_m(rng.uniform(-5, 5), rng.uniform(-5, 5));
  const Vector2d direction = unit(rng.uniform(-kPi, kPi));
  // Where the ray grazes the circle or an end of the arc either answer is right.
  const Vector2d to_centre = arc.centre_m - origin_m;
  const double offset_m = std::abs(direction.x() * to_centre.y() - direction.y() * to_centre.x());
  RC_PRE(std::abs(offset_m - arc.radius_m) > 1e-3);
  const auto range_m = distance_to_m(arc, origin_m, direction);
  const auto expected_m = marched_range_m(arc, origin_m, direction, 20);
  RC_ASSERT(range_m.has_value() == expected_m.has_value());
  RC_ASSERT(!range_m || std::abs(*range_m - *expected_m) < 1e-9);
}

RC_GTEST_PROP(RayCaster, EqualsTryingEveryWallAndEveryArc, (std::uint64_t seed)) {
  Rng rng(seed);
  World world = make_corridor({});
  for (int i = 0; i < 12; ++i) {
    world.arcs.push_back({.centre_m = {rng.uniform(0, 21), rng.uniform(0, 14.5)},
                          .radius_m = rng.uniform(0.05, 3),
                          .begin_rad = rng.uniform(-7, 7),
                          .sweep_rad = rng.uniform(0.2, 2 * kPi)});
  }
  const RayCaster caster(world);
  for (int k = 0; k < 300; ++k) {
    const Vector2d origin_m(rng.uniform(-2, 23), rng.uniform(-2, 16));
    const double direction_rad = rng.uniform(-10, 10);
    const double min_m = rng.uniform() < 0.5 ? 0 : rng.uniform(0, 5);
    const double max_m = rng.uniform(1, 30);
    double nearest_m = std::numeric_limits<double>::infinity();
    std::size_t nearest = 0;
    const auto take = [&](std::optional<double> range_m, std::size_t index) {
      if (!range_m || *range_m >= nearest_m || *range_m > max_m) return;
      nearest_m = *range_m;
      nearest = index;
    };
    for (std::size_t i = 0; i < world.walls.size(); ++i) {
      take(distance_to_m(world.walls[i], origin_m, unit(direction_rad), min_m), i);
    }
    for (std::size_t i = 0; i < world.arcs.size(); ++i) {
      take(distance_to_m(world.arcs[i], origin_m, unit(direction_rad), min_m),
           world.walls.size() + i);
    }
    const auto hit = caster.cast(origin_m, direction_rad, max_m, min_m);
    RC_ASSERT(hit.has_value() == std::isfinite(nearest_m));
    RC_ASSERT(!hit || (hit->range_m == nearest_m && hit->surface_index == nearest));
  }
}

RC_GTEST_PROP(Arc, ClearanceIsTheLeastDistanceToItsPoints, (std::uint64_t seed)) {
  Rng rng(seed);
  const Arc arc{.centre_m = {rng.uniform(-3, 3), rng.uniform(-3, 3)},
                .radius_m = rng.uniform(0.3, 3),
                .begin_rad = rng.uniform(-7, 7),
                .sweep_rad = rng.uniform(0.2, 2 * kPi)};
  const Vector2d point_m(rng.uniform(-5, 5), rng.uniform(-5, 5));
  double least_m = std::numeric_limits<double>::infinity();
  const int num_points = 20000;
  for (int i = 0; i <= num_points; ++i) {
    least_m =
        std::min(least_m, (arc.point_m(i / static_cast<double>(num_points)) - point_m).norm());
  }
  // Points at most 1 mm apart: none is nearer than the arc, one is at most half of it farther.
  const double clear_m = simulation::clearance_m(arc, point_m);
  RC_ASSERT(clear_m <= least_m + 1e-9 && clear_m >= least_m - 5e-4);
}

TEST(World, NormalOfAnArcPointsAwayFromItsCentre) {
  World world = world_of({{{0, 0}, {4, 0}}});
  world.arcs.push_back({.centre_m = {1, 1}, .radius_m = 2});
  EXPECT_LT((world.normal(0, {2, 0}) - Vector2d(0, 1)).norm(), kExact_m);
  EXPECT_LT((world.normal(1, {3, 1}) - Vector2d(1, 0)).norm(), kExact_m);
}

TEST(World, OutlineOfAnArcLiesOnItInPiecesOfAtMostFiveDegrees) {
  World world;
  world.arcs.push_back({.centre_m = {1, 1}, .radius_m = 2, .begin_rad = 1, .sweep_rad = 3});
  const auto lines_m = outlines_m(world);
  ASSERT_EQ(lines_m.size(), 1u);
  for (std::size_t i = 0; i < lines_m[0].size(); ++i) {
    EXPECT_NEAR((lines_m[0][i] - Vector2d(1, 1)).norm(), 2, kExact_m);
    if (i == 0) continue;
    EXPECT_LE((lines_m[0][i] - lines_m[0][i - 1]).norm(), 2 * 5 * kPi / 180);
  }
  EXPECT_LT((lines_m[0].front() - world.arcs[0].point_m(0)).norm(), kExact_m);
  EXPECT_LT((lines_m[0].back() - world.arcs[0].point_m(1)).norm(), kExact_m);
}

}  // namespace
}  // namespace corridor::simulation::testing
