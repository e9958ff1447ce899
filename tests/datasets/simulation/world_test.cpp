#include "datasets/simulation/world.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "tests/datasets/simulation/simulation_support.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::simulation::testing {
namespace {

using ::corridor::testing::ScratchFolder;

// Coordinates of tens of metres through a few rotations: some hundred times the rounding of a
// double.
constexpr double kExact_m = 1e-10;

double cross(const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
  return u.x() * v.y() - u.y() * v.x();
}

// Twice the signed area; the walls must be in order and closed.
double twice_area_m2(const std::vector<Segment>& walls) {
  double sum = 0;
  for (const Segment& wall : walls) sum += cross(wall.a_m, wall.b_m);
  return sum;
}

double distance_to_line_m(const Segment& line, const Eigen::Vector2d& point_m) {
  return std::abs(cross((line.b_m - line.a_m).normalized(), point_m - line.a_m));
}

RC_GTEST_PROP(Corridor, WallsFormOneClosedCounterClockwisePolygon, (std::uint64_t seed)) {
  Rng rng(seed);
  const World world = make_corridor(random_shape(rng));
  for (std::size_t i = 0; i < world.walls.size(); ++i) {
    const Segment& next = world.walls[(i + 1) % world.walls.size()];
    RC_ASSERT((world.walls[i].b_m - next.a_m).norm() < kExact_m);
  }
  RC_ASSERT(twice_area_m2(world.walls) > 0);
}

RC_GTEST_PROP(Corridor, KeyWallsHaveTheLengthsAAndB, (std::uint64_t seed)) {
  Rng rng(seed);
  const CorridorShape shape = random_shape(rng);
  const KeyWalls key = key_walls(shape);
  RC_ASSERT(std::abs(key.right_outer.length_m() - shape.a_m) < kExact_m);
  RC_ASSERT(std::abs(key.lower_outer.length_m() - shape.b_m) < kExact_m);
}

RC_GTEST_PROP(Corridor, InnerWallsAreParallelAtDistanceC, (std::uint64_t seed)) {
  Rng rng(seed);
  const CorridorShape shape = random_shape(rng);
  const KeyWalls key = key_walls(shape);
  for (const Eigen::Vector2d& point_m : {key.lower_inner.a_m, key.lower_inner.b_m}) {
    RC_ASSERT(std::abs(distance_to_line_m(key.lower_outer, point_m) - shape.c_m) < kExact_m);
  }
  for (const Eigen::Vector2d& point_m : {key.right_inner.a_m, key.right_inner.b_m}) {
    RC_ASSERT(std::abs(distance_to_line_m(key.right_outer, point_m) - shape.c_m) < kExact_m);
  }
}

RC_GTEST_PROP(Corridor, OuterWallsMeetAtTheInteriorAngleAlpha, (std::uint64_t seed)) {
  Rng rng(seed);
  const CorridorShape shape = random_shape(rng);
  const KeyWalls key = key_walls(shape);
  const Eigen::Vector2d back = key.lower_outer.a_m - key.lower_outer.b_m;
  const Eigen::Vector2d up = key.right_outer.b_m - key.right_outer.a_m;
  RC_ASSERT(std::abs(std::atan2(cross(up, back), up.dot(back)) - shape.alpha_rad) < 1e-12);
}

RC_GTEST_PROP(Corridor, EndWallsAreSquareToTheirArms, (std::uint64_t seed)) {
  Rng rng(seed);
  const CorridorShape shape = random_shape(rng);
  const KeyWalls key = key_walls(shape);
  RC_ASSERT(key.left_end.a_m.x() == 0 && key.left_end.b_m.x() == 0);
  RC_ASSERT(std::abs(key.left_end.length_m() - shape.c_m) < kExact_m);
  RC_ASSERT(std::abs(key.top_end.length_m() - shape.c_m) < kExact_m);
  RC_ASSERT(std::abs((key.top_end.b_m - key.top_end.a_m)
                         .normalized()
                         .dot((key.right_outer.b_m - key.right_outer.a_m).normalized())) < 1e-12);
}

RC_GTEST_PROP(Corridor, DoorsAddOnlyTheAreaOfTheirRecesses, (std::uint64_t seed)) {
  Rng rng(seed);
  CorridorShape shape = random_shape(rng);
  shape.doors_every_m = rng.uniform(1.5, 4);
  const World with_doors = make_corridor(shape);
  shape.doors_every_m = 0;
  const World without = make_corridor(shape);
  // Each recess replaces one wall by five.
  const std::size_t num_doors = (with_doors.walls.size() - without.walls.size()) / 4;
  const double added_m2 = 0.5 * (twice_area_m2(with_doors.walls) - twice_area_m2(without.walls));
  RC_ASSERT(std::abs(added_m2 - static_cast<double>(num_doors) * kDoorDepth_m * kDoorWidth_m) <
            1e-9);
}

TEST(Corridor, OfThePaperHasTheDrawnCorners) {
  const World world = make_corridor({});
  const double expected_m[][2] = {{0, 0}, {21, 0}, {21, 14.5}, {16, 14.5}, {16, 5}, {0, 5}};
  ASSERT_EQ(world.walls.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(world.walls[i].a_m.x(), expected_m[i][0], kExact_m) << "corner " << i;
    EXPECT_NEAR(world.walls[i].a_m.y(), expected_m[i][1], kExact_m) << "corner " << i;
  }
}

TEST(Corridor, OfThePaperHasSixDoorsInItsLowerWallEvery3400mm) {
  CorridorShape shape;
  shape.doors_every_m = 3.4;
  std::vector<double> centres_m;
  for (const Segment& wall : make_corridor(shape).walls) {
    if (wall.a_m.y() < -0.1 && wall.b_m.y() < -0.1) {
      centres_m.push_back(0.5 * (wall.a_m.x() + wall.b_m.x()));
    }
  }
  ASSERT_EQ(centres_m.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(centres_m[i], 1.7 + 3.4 * static_cast<double>(i), kExact_m);
  }
}

TEST(Corridor, ShapeThatCannotBeDrawnListsEveryRuleBroken) {
  const CorridorShape shape{
      .a_m = -1, .b_m = NAN, .c_m = 0, .alpha_rad = 0.1, .doors_every_m = 0.2};
  EXPECT_EQ(violations(shape).size(), 5u);
}

TEST(Corridor, ShapeOfMoreDoorsThanMemoryHoldsIsRefused) {
  const auto found = violations(CorridorShape{.a_m = 1e300, .b_m = 20'000, .doors_every_m = 1.5});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[1], "world.b_m = 20000: expected more than 0, at most 10000");
}

TEST(Corridor, ShapeWiderThanItsArmsAreLongIsRefused) {
  EXPECT_EQ(violations(CorridorShape{.a_m = 4, .b_m = 4, .c_m = 5}).size(), 2u);
}

TEST(ReadWorld, ReadsTheTableOfATruthFile) {
  const ScratchFolder folder;
  const auto path = folder.write("log.truth.toml",
                                 "[world]\na_m = 14.5\nb_m = 21\nc_m = 5.0\nalpha_deg = 80.0\n"
                                 "doors_every_m = 3.4\n[start]\nx_m = 2.0\n");
  const auto world = read_world(path);
  ASSERT_TRUE(world) << world.error().to_line();
  EXPECT_EQ(world->corridor->a_m, 14.5);
  EXPECT_EQ(world->corridor->b_m, 21);
  EXPECT_NEAR(world->corridor->alpha_rad, 80 * std::numbers::pi / 180, 1e-15);
  EXPECT_EQ(world->corridor->doors_every_m, 3.4);
}

TEST(ReadWorld, RefusesAnIntegerThatNoDoubleHolds) {
  const ScratchFolder folder;
  const auto world = read_world(folder.write("w.toml",
                                             "[world]\na_m = 9223372036854775807\nb_m = 21\n"
                                             "c_m = 5\nalpha_deg = 90\ndoors_every_m = 0\n"));
  ASSERT_FALSE(world);
  EXPECT_NE(world.error().to_line().find(
                "w.toml:2: world.a_m is out of range; expected number that a double holds"),
            std::string::npos)
      << world.error().to_line();
}

TEST(ReadWorld, NamesTheLineOfAnUnknownKeyAndOfAMissingOne) {
  const ScratchFolder folder;
  const auto path = folder.write("w.toml",
                                 "[world]\na_m = 14.5\nb_m = 21\nc_m = 5\nalpha_rad = 1.5\n"
                                 "doors_every_m = 0\n");
  const auto world = read_world(path);
  ASSERT_FALSE(world);
  EXPECT_NE(world.error().to_line().find("w.toml:5: unknown key world.alpha_rad"),
            std::string::npos)
      << world.error().to_line();
  EXPECT_NE(world.error().to_line().find("world.alpha_deg is missing"), std::string::npos);
}

TEST(ReadWorld, RefusesFilesWithoutAWorldAndFilesThatAreNotThere) {
  const ScratchFolder folder;
  EXPECT_EQ(read_world(folder.write("a.toml", "x = 1\n")).error().code, ErrorCode::kInvalid);
  EXPECT_EQ(read_world(folder.write("b.toml", "[world\n")).error().code, ErrorCode::kMalformed);
  EXPECT_EQ(read_world(folder / "none.toml").error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace corridor::simulation::testing
