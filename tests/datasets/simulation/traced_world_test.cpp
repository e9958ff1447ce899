#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "datasets/formats/maps/ros_map.hpp"
#include "datasets/simulation/lidar_model.hpp"
#include "datasets/simulation/ray_casting.hpp"
#include "datasets/simulation/simulate.hpp"
#include "datasets/simulation/world.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::simulation::testing {
namespace {

using ::corridor::testing::ScratchFolder;

// Rows from the top: '#' occupied, '.' free, '?' never seen.
GridMap map_of(const std::vector<std::string>& rows, double resolution_m,
               const Eigen::Vector2d& origin_m) {
  const int num_rows = static_cast<int>(rows.size());
  GridMap map(resolution_m, origin_m, static_cast<int>(rows[0].size()), num_rows);
  for (int row = 0; row < num_rows; ++row) {
    for (int column = 0; column < map.num_columns(); ++column) {
      const char sign =
          rows[static_cast<std::size_t>(num_rows - 1 - row)][static_cast<std::size_t>(column)];
      map.at(column, row) = {.log_odds = sign == '#'   ? 3.0f
                                         : sign == '.' ? -3.0f
                                                       : 0.0f,
                             .hits = 0,
                             .is_observed = sign != '?'};
    }
  }
  return map;
}

using Ends = std::array<double, 4>;  // x, y of the one, x, y of the other, the lesser first
std::vector<Ends> ends_of(const World& world) {
  std::vector<Ends> all;
  for (const Segment& wall : world.walls) {
    const Ends forth{wall.a_m.x(), wall.a_m.y(), wall.b_m.x(), wall.b_m.y()};
    const Ends back{wall.b_m.x(), wall.b_m.y(), wall.a_m.x(), wall.a_m.y()};
    all.push_back(std::min(forth, back));
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<Ends> sorted(std::vector<Ends> ends) {
  std::sort(ends.begin(), ends.end());
  return ends;
}

TEST(TracedWorld, BlockOfCellsIsFourWalls) {
  const World world = traced_world(map_of({"....", ".##.", "...."}, 0.5, {-1, 2}));
  EXPECT_EQ(
      ends_of(world),
      sorted({{-0.5, 2.5, 0.5, 2.5}, {-0.5, 3, 0.5, 3}, {-0.5, 2.5, -0.5, 3}, {0.5, 2.5, 0.5, 3}}));
  EXPECT_TRUE(world.route_m.empty());
  EXPECT_FALSE(world.corridor);
}

TEST(TracedWorld, AnglesAndTheMapsEdgesHaveWalls) {
  // An L in the lower left corner of the map.
  const World world = traced_world(map_of({"#..", "##."}, 1, {0, 0}));
  EXPECT_EQ(
      ends_of(world),
      sorted({{0, 0, 2, 0}, {1, 1, 2, 1}, {0, 2, 1, 2}, {0, 0, 0, 2}, {1, 1, 1, 2}, {2, 0, 2, 1}}));
}

TEST(TracedWorld, CellsNeverSeenAreNoObstacle) {
  EXPECT_EQ(traced_world(map_of({"?#?"}, 1, {0, 0})).walls.size(), 4u);
  EXPECT_TRUE(traced_world(map_of({"?.?"}, 1, {0, 0})).walls.empty());
}

TEST(TracedWorld, WallsLieWhereTheRayMeetsTheFirstOccupiedCell) {
  const World world = traced_world(map_of({"#####", "#...#", "#...#", "#####"}, 0.1, {3, 4}));
  const RayCaster caster(world);
  EXPECT_NEAR(*caster.range_m({3.25, 4.2}, 0, 10), 0.15, 1e-12);
  EXPECT_NEAR(*caster.range_m({3.25, 4.2}, std::numbers::pi / 2, 10), 0.1, 1e-12);
}

TEST(TracedWorld, OfARosMapCarriesAScenario) {
  std::vector<std::string> rows(30, std::string(80, '#'));
  for (std::size_t row = 5; row < 25; ++row) rows[row].replace(5, 70, 70, '.');
  const ScratchFolder folder;
  ASSERT_TRUE(formats::write_ros_map(map_of(rows, 0.2, {-1, -1}), folder / "hall"));
  const auto path = folder.write("hall.toml",
                                 "[world]\nmap = \"hall.yaml\"\nroute_m = [[2, 2], [12, 2]]\n"
                                 "[lidar]\nrange_sigma_m = 0\n");
  const auto scenario = read_scenario(path);
  ASSERT_TRUE(scenario) << scenario.error().to_line();
  const Simulated simulated = simulated_log(*scenario, 1);
  EXPECT_EQ(defects(simulated.log), std::vector<std::string>{});
  EXPECT_TRUE(simulated.log.provenance.notes.empty());
  // The hall's inside is 14 m x 4 m from (0, 0).
  std::size_t scan_index = 0;
  for (const SensorEvent& event : simulated.log.events) {
    const auto* scan = std::get_if<LaserScan>(&event);
    if (scan == nullptr) continue;
    const Pose2 T_world_base = (*simulated.log.truth)[scan_index++].T_map_base;
    for (std::size_t i = 0; i < scan->num_beams(); i += 30) {
      if (!scan->is_valid[i]) continue;
      const Eigen::Vector2d end_m = T_world_base * scan->point_base_m(i);
      const double off_m = std::min({std::abs(end_m.x()), std::abs(end_m.x() - 14),
                                     std::abs(end_m.y()), std::abs(end_m.y() - 4)});
      EXPECT_LT(off_m, 1e-6);
    }
  }
}

// A corridor of 20 m x 3 m with walls of 0.3 m, turned about the origin, as a map of 5 cm cells.
Scenario turned_corridor(double turned_rad) {
  const double resolution_m = 0.05;
  const int side_cells = 640;
  GridMap map(resolution_m, {-6, -6}, side_cells, side_cells);
  const Eigen::Vector2d along(std::cos(turned_rad), std::sin(turned_rad));
  const Eigen::Vector2d across(-along.y(), along.x());
  const auto is_within = [&](const Eigen::Vector2d& point_m, double margin_m) {
    return std::abs(point_m.dot(along) - 10) < 10 + margin_m &&
           std::abs(point_m.dot(across)) < 1.5 + margin_m;
  };
  for (int row = 0; row < side_cells; ++row) {
    for (int column = 0; column < side_cells; ++column) {
      const Eigen::Vector2d centre_m = map.centre_m(column, row);
      const bool is_wall = is_within(centre_m, 0.3) && !is_within(centre_m, 0);
      map.at(column, row) = {.log_odds = is_wall ? 3.f : -3.f, .is_observed = true};
    }
  }
  Scenario scenario;
  scenario.world = traced_world(map);
  scenario.world.route_m = {2 * along, 18 * along};
  scenario.lidar.range_sigma_m = 0;
  return scenario;
}

TEST(TracedWorld, TurnedCorridorIsDegenerateAlongItselfAtTheSameTimes) {
  const Simulated straight = simulated_log(turned_corridor(0), 1);
  ASSERT_EQ(straight.truth.degenerate->size(), 1u);
  const DegenerateInterval expected = straight.truth.degenerate->front();
  EXPECT_GT(expected.end_s - expected.begin_s, 10);
  for (const double turned_deg : {0.0, 5.0, 20.0, 45.0}) {
    SCOPED_TRACE(turned_deg);
    const double turned_rad = turned_deg * std::numbers::pi / 180;
    const Scenario scenario = turned_corridor(turned_rad);
    const Simulated turned = simulated_log(scenario, 1);
    ASSERT_EQ(turned.truth.degenerate->size(), 1u);
    const DegenerateInterval found = turned.truth.degenerate->front();
    // The end walls lie within two cells of one another: 0.2 s of driving, and a scan.
    EXPECT_NEAR(found.begin_s, expected.begin_s, 0.4);
    EXPECT_NEAR(found.end_s, expected.end_s, 0.4);
    const double degree_rad = std::numbers::pi / 180;
    EXPECT_NEAR(found.direction_rad.value(), turned_rad, degree_rad);
    // What the beams hit in the middle of it are two walls along it.
    const LidarModel lidar(scenario.world, scenario.lidar);
    const Pose2 middle(10 * std::cos(turned_rad), 10 * std::sin(turned_rad), turned_rad);
    for (const auto& hit : lidar.sweep([&](double) { return middle; }, {}).hits) {
      if (!hit) continue;
      EXPECT_LT(
          std::abs(hit->normal.dot(Eigen::Vector2d(std::cos(turned_rad), std::sin(turned_rad)))),
          std::sin(degree_rad));
    }
  }
}

TEST(TracedWorld, MapThatIsNotThereIsNamedWithItsLine) {
  const ScratchFolder folder;
  const auto scenario = read_scenario(folder.write("x.toml", "[world]\nmap = \"none.yaml\"\n"));
  ASSERT_FALSE(scenario);
  EXPECT_NE(scenario.error().to_line().find("x.toml:2: "), std::string::npos)
      << scenario.error().to_line();
}

}  // namespace
}  // namespace corridor::simulation::testing
