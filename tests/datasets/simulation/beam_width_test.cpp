// Beams with a width: what they read where they meet one surface, and where an edge parts them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "datasets/simulation/lidar_model.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

constexpr double kExact_m = 1e-9;
constexpr double kDegree_rad = std::numbers::pi / 180;

Sweep sweep_at(const World& world, const LidarParams& params, const Pose2& T_world_base = {}) {
  return LidarModel(world, params).sweep([&](double) { return T_world_base; }, {});
}

// 200 beams within 10 degrees to either side, each 0.5 deg wide.
LidarParams wide_beams() {
  LidarParams params{.num_beams = 200, .field_of_view_deg = 20, .range_max_m = 60};
  params.beam_width_deg = 0.5;
  params.mixed_pixel_ratio = 1;
  return params;
}

// Every beam reads what a line through its middle reads, and nothing of a second surface.
void expect_ranges_of_lines(const World& world, const LidarParams& wide,
                            const Pose2& T_world_base = {}) {
  LidarParams line = wide;
  line.beam_width_deg = 0;
  const Sweep found = sweep_at(world, wide, T_world_base);
  const Sweep expected = sweep_at(world, line, T_world_base);
  for (std::size_t i = 0; i < found.ranges_m.size(); ++i) {
    EXPECT_NEAR(found.ranges_m[i], expected.ranges_m[i], kExact_m) << i;
    EXPECT_EQ(found.other_ranges_m[i], 0) << i;
    EXPECT_EQ(found.hits[i].has_value(), expected.hits[i].has_value()) << i;
  }
}

// A wall that the middle of the view meets at this angle to its normal, 5 m away.
World oblique_wall(double incidence_deg) {
  const Eigen::Vector2d along(std::sin(incidence_deg * kDegree_rad),
                              std::cos(incidence_deg * kDegree_rad));
  return world_of({{Eigen::Vector2d(5, 0) - 4.5 * along, Eigen::Vector2d(5, 0) + 40 * along}});
}

TEST(LidarBeamWidth, LeavesAnObliqueWallStraight) {
  for (const double incidence_deg : {0.0, 60.0, 75.0, 80.0, 85.0}) {
    SCOPED_TRACE(incidence_deg);
    LidarParams params = wide_beams();
    params.field_of_view_deg = 4;  // within 2 degrees of it
    expect_ranges_of_lines(oblique_wall(incidence_deg), params);
    params.range_max_m = 5.05;  // and where it leaves the sensor's range
    expect_ranges_of_lines(oblique_wall(incidence_deg), params);
  }
}

TEST(LidarBeamWidth, LeavesAWallOfShortPiecesStraight) {
  const Segment wall = oblique_wall(80).walls.front();
  std::vector<Segment> pieces;
  const int num_pieces = 2000;  // of 22 mm: many between two rays of a beam
  for (int i = 0; i < num_pieces; ++i) {
    const Eigen::Vector2d step_m = (wall.b_m - wall.a_m) / num_pieces;
    pieces.push_back({wall.a_m + i * step_m, wall.a_m + (i + 1) * step_m});
  }
  LidarParams params = wide_beams();
  params.field_of_view_deg = 10;
  expect_ranges_of_lines(world_of(std::move(pieces)), params);
}

TEST(LidarBeamWidth, LeavesAnArcRoundOutsideAndInside) {
  World world;
  // Met from inside at up to 80 deg near the rim.
  world.arcs = {{.centre_m = {0, 0}, .radius_m = 6}};
  LidarParams params = wide_beams();
  params.field_of_view_deg = 360;
  params.num_beams = 720;
  const double off_centre_m = 6 * std::sin(80 * kDegree_rad);
  expect_ranges_of_lines(world, params, {off_centre_m, 0, 0.1});
  // From outside: a quarter of a circle in pieces of 3 degrees.
  world.arcs.clear();
  for (int i = 0; i < 30; ++i) {
    world.arcs.push_back({.centre_m = {20, -10},
                          .radius_m = 10,
                          .begin_rad = (90 + 3 * i) * kDegree_rad,
                          .sweep_rad = 3 * kDegree_rad});
  }
  params.num_beams = 200;
  params.field_of_view_deg = 10;  // up to 80 deg of incidence where the beams graze its top
  expect_ranges_of_lines(world, params, {0, -1.5, -0.1});
}

TEST(LidarBeamWidth, LeavesConcaveCornersSharp) {
  // The ends of a long corridor: walls at 80 to 90 deg of incidence, met by the end wall.
  expect_ranges_of_lines(world_of({{{-9, 1}, {20, 1}}, {{20, 1}, {20, -1}}, {{20, -1}, {-9, -1}}}),
                         wide_beams());
}

TEST(LidarBeamWidth, PartsAnObliqueWallFromTheWallBehindItsEnd) {
  // Along a wall at 80 deg of incidence that ends 5 m away; the next wall is 12 m away.
  const Segment wall = oblique_wall(80).walls.front();
  const World world = world_of({{wall.a_m, {5, 0}}, {{12, -30}, {12, 30}}});
  LidarParams params = wide_beams();
  params.num_beams = 201;  // the middle one meets the end in its middle
  const Sweep sweep = sweep_at(world, params);
  int num_parted = 0;
  for (std::size_t i = 0; i < 201; ++i) {
    const double direction_deg =
        std::abs(beam_angle_rad(params, static_cast<int>(i))) / kDegree_rad;
    EXPECT_EQ(sweep.other_ranges_m[i] > 0, direction_deg < 0.25) << i;
    num_parted += sweep.other_ranges_m[i] > 0;
    if (sweep.other_ranges_m[i] == 0) continue;
    const auto [near_m, far_m] = std::minmax(sweep.ranges_m[i], sweep.other_ranges_m[i]);
    EXPECT_GT(near_m, 4.8);
    EXPECT_LE(near_m, 5 + kExact_m);
    EXPECT_NEAR(far_m, 12, 0.001);
  }
  EXPECT_EQ(num_parted, 5);  // 0.5 deg of beams 0.1 deg apart
}

TEST(LidarBeamWidth, SeesTheWallOnBothSidesOfAThinPostAsOne) {
  // 2 of 5 rays meet a post 2 m away, 3 the wall at 4 m on either side of it.
  const double half_m = 2 * std::tan(0.1 * kDegree_rad);
  const World world = world_of({{{2, -half_m}, {2, half_m / 5}}, {{4, -9}, {4, 9}}});
  LidarParams params{.num_beams = 5, .field_of_view_deg = 10};
  params.beam_width_deg = 0.36;
  const Sweep sweep = sweep_at(world, params);
  EXPECT_NEAR(sweep.ranges_m[2], 4, 1e-3);
  EXPECT_NEAR(sweep.other_ranges_m[2], 2, 1e-3);
}

// A plate whose edge lies in the middle beam, 2 m away, and a wall behind it, 4 m away.
TEST(LidarBeamWidth, MixedPixelsLieBetweenTheTwoSurfaces) {
  const World world = world_of({{{2, 0}, {2, -9}}, {{4, -9}, {4, 9}}});
  LidarParams params{.num_beams = 5, .field_of_view_deg = 10, .range_sigma_m = 0};
  params.beam_width_deg = 1;
  params.mixed_pixel_ratio = 0.4;
  const LidarModel lidar(world, params);
  const Sweep sweep = sweep_at(world, params);
  EXPECT_NEAR(sweep.ranges_m[2], 2, 1e-3);
  EXPECT_NEAR(sweep.other_ranges_m[2], 4, 1e-3);
  const int num_scans = 4000;
  std::vector<double> mixed_m;
  for (std::uint64_t k = 0; k < num_scans; ++k) {
    const LaserScan scan = lidar.measure(sweep, Rng(1).stream(k));
    const double range_m = scan.ranges_m[2];
    EXPECT_GE(range_m, 2 - 1e-3);
    EXPECT_LE(range_m, 4 + 1e-3);
    if (range_m > 2.001) mixed_m.push_back(range_m);
    for (const std::size_t single : {0u, 1u, 3u, 4u}) {  // beams that meet one surface
      EXPECT_NEAR(scan.ranges_m[single], sweep.hits[single]->range_m, 1e-3);
    }
  }
  EXPECT_NEAR(static_cast<double>(mixed_m.size()) / num_scans, 0.4,
              5 * std::sqrt(0.4 * 0.6 / num_scans));
  const double sigma_m = 2 / std::sqrt(12.0);  // uniform from 2 m to 4 m
  EXPECT_NEAR(mean(mixed_m), 3, 5 * sigma_m / std::sqrt(static_cast<double>(mixed_m.size())));
}

}  // namespace
}  // namespace corridor::simulation::testing
