#include "datasets/simulation/ray_casting.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <Eigen/LU>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

constexpr double kExact_m = 1e-9;
constexpr double kFar_m = 1000;

// Second implementation: parametric line through the wall, by Cramer's rule, every wall tried.
std::optional<double> brute_force_range_m(const World& world, const Eigen::Vector2d& origin_m,
                                          double direction_rad) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Segment& wall : world.walls) {
    Eigen::Matrix2d columns;
    columns.col(0) = Eigen::Vector2d(std::cos(direction_rad), std::sin(direction_rad));
    columns.col(1) = wall.a_m - wall.b_m;
    if (std::abs(columns.determinant()) < 1e-13) continue;
    const Eigen::Vector2d solution = columns.inverse() * (wall.a_m - origin_m);
    const bool is_on_wall = solution.y() >= -1e-12 && solution.y() <= 1 + 1e-12;
    if (is_on_wall && solution.x() > 0) nearest_m = std::min(nearest_m, solution.x());
  }
  if (!std::isfinite(nearest_m)) return std::nullopt;
  return nearest_m;
}

RC_GTEST_PROP(RayCaster, EqualsTryingEveryWall, (std::uint64_t seed)) {
  Rng rng(seed);
  const CorridorShape shape = random_shape(rng);
  const World world = make_corridor(shape);
  const RayCaster caster(world);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d origin_m = random_point_inside(shape, rng);
    const double direction_rad = rng.uniform(-10, 10);
    const auto range_m = caster.range_m(origin_m, direction_rad, kFar_m);
    const auto expected_m = brute_force_range_m(world, origin_m, direction_rad);
    RC_ASSERT(range_m.has_value() && expected_m.has_value());
    // A ray that grazes a wall at angle g meets it rounding / g away: relative, not absolute.
    RC_ASSERT(std::abs(*range_m - *expected_m) < kExact_m * std::max(1.0, *expected_m));
  }
}

RC_GTEST_PROP(RayCaster, EveryRayFromInsideMeetsAWallAtAnyAngle, (std::uint64_t seed)) {
  Rng rng(seed);
  const CorridorShape shape = random_shape(rng);
  const World world = make_corridor(shape);
  const RayCaster caster(world);
  const Eigen::Vector2d origin_m = random_point_inside(shape, rng);
  // At the walls' own corners, where a gap of one rounding would let rays out.
  for (const Segment& wall : world.walls) {
    const Eigen::Vector2d to_corner = wall.a_m - origin_m;
    const auto range_m = caster.range_m(origin_m, std::atan2(to_corner.y(), to_corner.x()), kFar_m);
    RC_ASSERT(range_m.has_value());
  }
}

RC_GTEST_PROP(RayCaster, HitLiesOnTheWallItNames, (std::uint64_t seed)) {
  Rng rng(seed);
  const CorridorShape shape = random_shape(rng);
  const World world = make_corridor(shape);
  const RayCaster caster(world);
  const Eigen::Vector2d origin_m = random_point_inside(shape, rng);
  const double direction_rad = rng.uniform(-4, 4);
  const auto hit = caster.cast(origin_m, direction_rad, kFar_m);
  RC_ASSERT(hit.has_value());
  const Eigen::Vector2d end_m =
      origin_m + hit->range_m * Eigen::Vector2d(std::cos(direction_rad), std::sin(direction_rad));
  RC_ASSERT(clearance_m(world_of({world.walls[hit->surface_index]}), end_m) < 2 * kExact_m);
}

TEST(RayCaster, MeasuresThePaperCorridorFromItsStart) {
  const RayCaster caster(make_corridor({}));
  const Eigen::Vector2d start_m(2.5, 2.5);
  const double pi = std::numbers::pi;
  EXPECT_NEAR(*caster.range_m(start_m, 0, kFar_m), 18.5, kExact_m);
  EXPECT_NEAR(*caster.range_m(start_m, pi / 2, kFar_m), 2.5, kExact_m);
  EXPECT_NEAR(*caster.range_m(start_m, pi, kFar_m), 2.5, kExact_m);
  EXPECT_NEAR(*caster.range_m(start_m, -pi / 2, kFar_m), 2.5, kExact_m);
  EXPECT_NEAR(*caster.range_m(start_m, pi / 4, kFar_m), 2.5 * std::numbers::sqrt2, kExact_m);
  // Around the corner: from the first arm to the right outer wall, past the inner corner.
  EXPECT_NEAR(*caster.range_m(start_m, std::atan2(2.0, 18.5), kFar_m), std::hypot(18.5, 2.0),
              kExact_m);
}

TEST(RayCaster, SeesNothingBeyondItsRangeAndTheWallExactlyAtIt) {
  const RayCaster caster(make_corridor({}));
  EXPECT_FALSE(caster.range_m({2.5, 2.5}, 0, 18.4));
  EXPECT_TRUE(caster.range_m({2.5, 2.5}, 0, 18.5 + kExact_m));
}

TEST(RayCaster, RayAlongAWallMissesItAndMeetsTheNext) {
  const RayCaster caster(world_of({{{1, 0}, {3, 0}}, {{5, -1}, {5, 1}}}));
  EXPECT_NEAR(*caster.range_m({0, 0}, 0, kFar_m), 5, kExact_m);
}

TEST(RayCaster, SeesWallsFromOutsideTheirBox) {
  const RayCaster caster(make_corridor({}));
  EXPECT_NEAR(*caster.range_m({-10, 2}, 0, kFar_m), 10, kExact_m);
  EXPECT_FALSE(caster.range_m({-10, 2}, std::numbers::pi, kFar_m));
}

TEST(RayCaster, SeesNothingInAWorldWithoutWalls) {
  EXPECT_FALSE(RayCaster(World{}).range_m({0, 0}, 1, kFar_m));
}

}  // namespace
}  // namespace corridor::simulation::testing
