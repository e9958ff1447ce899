// The world that a seed draws, found in recorded logs by what the LiDAR sees of its walls.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/datasets/simulation/from_log_support.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

using Eigen::Vector2d;

// A robot that stands this far from the left end and looks along the first arm.
Scenario stay_in(const CorridorShape& shape, double from_left_end_m) {
  Scenario scenario = honest_stay(0.2);
  scenario.world = make_corridor(shape);
  scenario.lidar.num_beams = 64;
  scenario.drive.end_margin_m = from_left_end_m;
  return scenario;
}

// Where the beam nearest to a direction ends, in the base frame, whose x axis is along the arm.
Vector2d end_m(const RecordedRun& run, double direction_deg) {
  const LaserScan scan = readings<LaserScan>(run.log).front();
  const double direction_rad = direction_deg * std::numbers::pi / 180;
  const double index = std::round((direction_rad - scan.angle_min_rad) / scan.angle_increment_rad);
  return scan.point_base_m(static_cast<std::size_t>(index));
}

double first_arm_m(const RecordedRun& run) { return end_m(run, 0).x() - end_m(run, 179).x(); }
double second_arm_m(const RecordedRun& run) { return end_m(run, 90).y() - end_m(run, -90).y(); }
double width_m(const RecordedRun& run) { return end_m(run, 135).y() - end_m(run, -135).y(); }

// Both arms so short and wide that a robot in the square between them sees all six walls.
constexpr CorridorShape kWide{.a_m = 12, .b_m = 12, .c_m = 8};
constexpr double kInTheSquare_m = 6;

TEST(WorldSpread, OfLengthsOverLogsIsTheStatedOne) {
  Scenario scenario = stay_in(kWide, kInTheSquare_m);
  scenario.draw.length_spread = 0.05;
  const double part = uniform_sigma(0.05);
  expect_spreads(scenario, {{"first arm", first_arm_m, kWide.b_m, kWide.b_m * part},
                            {"second arm", second_arm_m, kWide.a_m, kWide.a_m * part},
                            {"width", width_m, kWide.c_m, kWide.c_m * part}});
}

// Of the right outer wall against the first arm. The way of the robot would not do: from where it
// has turned, past the corner, it heads straight for the last waypoint, not along the wall.
double alpha_deg(const RecordedRun& run) {
  const Vector2d wall_m = end_m(run, 3) - end_m(run, -3);
  return 180 - std::atan2(wall_m.y(), wall_m.x()) * 180 / std::numbers::pi;
}

constexpr double kInTheFirstArm_m = 9;  // sees 1 m of that wall between two beams

TEST(WorldSpread, OfTheAngleOverLogsIsTheStatedOne) {
  Scenario scenario = stay_in({}, kInTheFirstArm_m);
  scenario.draw.alpha_spread_deg = 20;
  expect_spreads(scenario, {{"alpha", alpha_deg, 90, uniform_sigma(20)}});
}

}  // namespace
}  // namespace corridor::simulation::testing
