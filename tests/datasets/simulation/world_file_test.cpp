// Drawn worlds in TOML; the corridor's keys are tested in world_test.cpp.
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "datasets/simulation/world.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::simulation::testing {
namespace {

using ::corridor::testing::ScratchFolder;
using Eigen::Vector2d;

Result<World> world_from(const std::string& text) {
  const ScratchFolder folder;
  return read_world(folder.write("w.toml", text));
}

std::string error_of(const std::string& text) {
  const auto world = world_from(text);
  return world ? "no error" : world.error().to_line();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

constexpr const char* kDrawing =
    "[world]\n"                                                                           // 1
    "materials = [{ name = \"wall\" }, { name = \"glass\", seen_within_deg = 15 }]\n"     // 2
    "polygons = [\n"                                                                      // 3
    "  { points_m = [[0, 0], [4, 0], [4, 3]] },\n"                                        // 4
    "  { points_m = [[0, 5], [4, 5], [4, 6]], closed = false, material = \"glass\" },\n"  // 5
    "]\n"                                                                                 // 6
    "arcs = [{ centre_m = [1, 2], radius_m = 0.5, begin_deg = 90, sweep_deg = 180 }]\n"   // 7
    "route_m = [[-1, -1], [5, -1]]\n";                                                    // 8

TEST(DrawnWorld, ClosedPolygonsReturnToTheirBeginningAndOpenOnesDoNot) {
  const auto world = world_from(kDrawing);
  ASSERT_TRUE(world) << world.error().to_line();
  ASSERT_EQ(world->walls.size(), 5u);
  EXPECT_EQ(world->walls[2].a_m, Vector2d(4, 3));
  EXPECT_EQ(world->walls[2].b_m, Vector2d(0, 0));
  EXPECT_EQ(world->walls[4].b_m, Vector2d(4, 6));
  ASSERT_EQ(world->arcs.size(), 1u);
  EXPECT_NEAR(world->arcs[0].begin_rad, std::numbers::pi / 2, 1e-15);
  EXPECT_NEAR(world->arcs[0].sweep_rad, std::numbers::pi, 1e-15);
  EXPECT_EQ(world->route_m.size(), 2u);
  EXPECT_FALSE(world->corridor);
}

TEST(DrawnWorld, SurfacesHaveTheirMaterialAndTheFirstWhereNoneIsNamed) {
  const auto world = world_from(kDrawing);
  ASSERT_TRUE(world);
  EXPECT_EQ(world->material(0).name, "wall");
  EXPECT_EQ(world->material(3).name, "glass");
  EXPECT_EQ(world->material(4).seen_within_deg, 15);
  EXPECT_EQ(world->material(5).name, "wall");  // the arc
}

TEST(DrawnWorld, WithoutMaterialsIsPlain) {
  const auto world = world_from("[world]\narcs = [{ centre_m = [0, 0], radius_m = 2 }]\n");
  ASSERT_TRUE(world) << world.error().to_line();
  EXPECT_EQ(world->material(0), Material{});
  EXPECT_NEAR(world->arcs[0].sweep_rad, 2 * std::numbers::pi, 1e-15);
}

TEST(DrawnWorld, WrittenAndReadAgainIsTheSame) {
  Rng rng(1);
  World world;
  world.materials = {{"wall", 1, 90}, {"dark", 1.0 / 3, 90}, {"glass", 0.9, 12.3456789}};
  for (int i = 0; i < 40; ++i) {
    world.walls.push_back({{rng.uniform(-50, 50), rng.uniform(-50, 50)},
                           {rng.uniform(-50, 50), rng.uniform(-50, 50)}});
  }
  for (int i = 0; i < 20; ++i) {
    world.arcs.push_back({{rng.uniform(-50, 50), rng.uniform(-50, 50)},
                          rng.uniform(0.1, 5),
                          rng.uniform(-3, 3),
                          rng.uniform(0.1, 6.2)});
  }
  world.arcs.push_back({.centre_m = {100, 100}});  // a whole circle
  for (std::size_t i = 0; i < world.num_surfaces(); ++i) {
    world.material_of_surface.push_back(static_cast<std::uint8_t>(rng.below(3)));
  }
  const auto again = world_from(world_toml(world));
  ASSERT_TRUE(again) << again.error().to_line();
  ASSERT_EQ(again->walls.size(), world.walls.size());
  ASSERT_EQ(again->arcs.size(), world.arcs.size());
  for (std::size_t i = 0; i < world.walls.size(); ++i) {
    EXPECT_EQ(again->walls[i].a_m, world.walls[i].a_m);
    EXPECT_EQ(again->walls[i].b_m, world.walls[i].b_m);
  }
  for (std::size_t i = 0; i < world.arcs.size(); ++i) {
    EXPECT_EQ(again->arcs[i].centre_m, world.arcs[i].centre_m);
    EXPECT_EQ(again->arcs[i].radius_m, world.arcs[i].radius_m);
    EXPECT_NEAR(again->arcs[i].begin_rad, world.arcs[i].begin_rad, 1e-14);
    EXPECT_NEAR(again->arcs[i].sweep_rad, world.arcs[i].sweep_rad, 1e-14);
  }
  EXPECT_EQ(again->materials, world.materials);
  EXPECT_EQ(again->material_of_surface, world.material_of_surface);
}

TEST(DrawnWorld, RouteIsWrittenAndReadAgain) {
  const auto world = world_from(kDrawing);
  ASSERT_TRUE(world);
  const auto again = world_from(world_toml(*world));
  ASSERT_TRUE(again) << again.error().to_line();
  EXPECT_EQ(again->route_m, world->route_m);
}

TEST(DrawnWorld, NamesEveryProblemWithItsLine) {
  const std::string error = error_of(
      "[world]\n"                                                   // 1
      "polygons = [\n"                                              // 2
      "  { points_m = [[0, 0]] },\n"                                // 3
      "  { points_m = [[0, 0], [1, \"x\"]] },\n"                    // 4
      "  { points_m = [[0, 0], [1, 1]], closed = 1 },\n"            // 5
      "  { points_m = [[0, 0], [1, 1]], colour = \"red\" },\n"      // 6
      "  { points_m = [[0, 0], [1, 1]], material = \"brick\" },\n"  // 7
      "]\n"                                                         // 8
      "arcs = [{ radius_m = 2 }]\n"                                 // 9
      "lamps = 3\n");                                               // 10
  EXPECT_TRUE(contains(error, "w.toml:3: world.polygons: expected at least two")) << error;
  EXPECT_TRUE(contains(error, "w.toml:4: world.polygons.points_m: expected a point")) << error;
  EXPECT_TRUE(
      contains(error, "w.toml:5: world.polygons.closed is a whole number; expected true or false"))
      << error;
  EXPECT_TRUE(contains(error, "w.toml:6: unknown key world.polygons.colour")) << error;
  EXPECT_TRUE(contains(error, "w.toml:7: material \"brick\" is not in")) << error;
  EXPECT_TRUE(contains(error, "w.toml:9: world.arcs.centre_m is missing")) << error;
  EXPECT_TRUE(contains(error, "w.toml:10: unknown key world.lamps")) << error;
}

TEST(DrawnWorld, RefusesSurfacesWithoutLengthAndMaterialsOutOfRange) {
  EXPECT_TRUE(contains(error_of("[world]\npolygons = [{ points_m = [[1, 1], [1, 1]] }]\n"),
                       "world: wall 0"));
  EXPECT_TRUE(contains(error_of("[world]\narcs = [{ centre_m = [0, 0], radius_m = 1, "
                                "sweep_deg = 400 }]\n"),
                       "world: arc 0"));
  const std::string arc = "arcs = [{ centre_m = [0, 0], radius_m = 1 }]\n";
  EXPECT_TRUE(
      contains(error_of("[world]\nmaterials = [{ name = \"a\", range_factor = 1.5 }]\n" + arc),
               "range_factor = 1.5"));
  EXPECT_TRUE(
      contains(error_of("[world]\nmaterials = [{ name = \"a\", seen_within_deg = 0 }]\n" + arc),
               "seen_within_deg = 0"));
}

// Surfaces name their material, so that two of one name could not be told apart when read again.
TEST(DrawnWorld, RefusesMaterialsWhoseNamesCannotBeReadBack) {
  const std::string arc = "arcs = [{ centre_m = [0, 0], radius_m = 1 }]\n";
  for (const std::string names :
       {"{ name = \"a\" }, { name = \"a\" }", "{ name = \"\" }", "{ name = 'say \"a\"' }",
        "{ name = 'a\\b' }", "{ name = \"a\\u0001\" }"}) {
    EXPECT_TRUE(contains(error_of("[world]\nmaterials = [" + names + "]\n" + arc),
                         "expected a name that no other has"))
        << names;
  }
}

TEST(DrawnWorld, RefusesARouteThatIsLongerThanAnyDrive) {
  World world = world_of({{{0, 1}, {10, 1}}});
  world.route_m = {{0, -90'000}, {0, -1}};
  EXPECT_TRUE(contains(violations(world).at(0), "world.route_m: 89999 m up to point 2"));
}

TEST(DrawnWorld, RefusesPointsOfTheRouteThatAreNowhere) {
  World world = world_of({{{0, 1}, {10, 1}}});
  for (const double number : {1e300, std::numeric_limits<double>::quiet_NaN()}) {
    world.route_m = {{0, 0}, {number, 0}};
    EXPECT_TRUE(contains(violations(world).at(0), "world.route_m: point 2 is ("));
    world.route_m = {{number, 0}};
    EXPECT_TRUE(contains(violations(world).at(0), "world.route_m: point 1 is ("));
  }
}

TEST(DrawnWorld, RefusesARouteThatStandsStill) {
  World world = world_of({{{0, 1}, {10, 1}}});
  world.route_m = {{0, 0}, {5, 0}, {5, 0}};
  EXPECT_TRUE(contains(violations(world).at(0), "points 2 and 3 are both (5, 0) m"));
}

}  // namespace
}  // namespace corridor::simulation::testing
