// What a log states of its LiDAR's noise against what its ranges are off.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>

#include "datasets/simulation/simulate.hpp"
#include "tests/datasets/simulation/from_log_support.hpp"
#include "tests/datasets/simulation/simulation_support.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::simulation::testing {
namespace {

using Eigen::Vector2d;

constexpr double kDegree_rad = std::numbers::pi / 180;

// The surface that a line from a point meets first, by trying every one.
struct Met {
  double range_m = std::numeric_limits<double>::infinity();
  std::size_t surface_index = 0;
};
Met nearest(const World& world, const Vector2d& origin_m, double direction_rad) {
  const Vector2d direction(std::cos(direction_rad), std::sin(direction_rad));
  Met nearest;
  for (std::size_t i = 0; i < world.walls.size(); ++i) {
    const auto range_m = distance_to_m(world.walls[i], origin_m, direction);
    if (range_m && *range_m < nearest.range_m) nearest = {*range_m, i};
  }
  return nearest;
}

// Squares of the errors of beams whose whole width meets one wall.
std::vector<double> square_errors_m2(const Scenario& scenario, const SensorLog& log) {
  std::map<std::size_t, std::optional<double>> truth_m;  // per beam; the robot stands
  std::vector<double> squares_m2;
  for (const LoggedBeam& beam : logged_beams(log)) {
    if (truth_m.count(beam.index) == 0) {
      const double direction_rad = beam.T_world_base.theta_rad() + beam.angle_rad;
      const double half_rad = scenario.lidar.beam_width_deg * kDegree_rad / 2;
      const auto meet = [&](double turned_rad) {
        return nearest(scenario.world, beam.T_world_base.translation_m(),
                       direction_rad + turned_rad);
      };
      const Met middle = meet(0);
      const bool is_one = meet(-half_rad).surface_index == middle.surface_index &&
                          meet(half_rad).surface_index == middle.surface_index;
      // Noise may take what lies near the limit out of the log.
      const bool is_near = middle.range_m < 0.95 * scenario.lidar.range_max_m;
      truth_m[beam.index] = is_one && is_near ? std::optional(middle.range_m) : std::nullopt;
    }
    const std::optional<double> expected_m = truth_m[beam.index];
    if (beam.is_valid && expected_m) {
      squares_m2.push_back(std::pow(beam.range_m - *expected_m, 2));
    }
  }
  return squares_m2;
}

TEST(StatedRangeNoise, OfNothingButWhiteNoiseIsThatToTheLastBit) {
  for (const double sigma_m : {0.0, 0.005, 0.015, 0.1, 1.0 / 3}) {
    Scenario scenario;
    scenario.lidar.range_sigma_m = sigma_m;
    EXPECT_EQ(nominal_robot(scenario).lidar.range_sigma_m, sigma_m);
  }
  EXPECT_EQ(nominal_robot({}).lidar.range_sigma_m, 0.015);
}

TEST(StatedRangeNoise, AddsTheSquaresOfWhatTheOtherErrorsDoTypically) {
  LidarParams params{.range_max_m = 6, .range_sigma_m = 0.003, .range_sigma_ratio = 0.004};
  params.range_sigma_incidence_m = 0.005;
  params.range_step_m = 0.02;
  // 3 mm; 12 mm at half of 6 m; 5 mm at 45 degrees; 20 mm / sqrt(12).
  EXPECT_NEAR(stated_range_sigma_m(params), std::sqrt(9 + 144 + 25 + 400 / 12.0) * 1e-3, 1e-12);
  params.range_max_m = 30;  // 16 mm at 4 m
  EXPECT_NEAR(stated_range_sigma_m(params), std::sqrt(9 + 256 + 25 + 400 / 12.0) * 1e-3, 1e-12);
}

// Half of the limits that the data sheets give, at the ranges for which they give them.
TEST(StatedRangeNoise, OfThePresetsIsHalfOfTheirDataSheetsLimits) {
  struct Limit {
    std::string preset;
    double range_m, accuracy_m;
  };
  const ::corridor::testing::ScratchFolder folder;
  for (const Limit& limit : {Limit{"urg-04lx", 1, 0.01},
                             {"urg-04lx", 4, 0.04},
                             {"utm-30lx", 10, 0.03},
                             {"utm-30lx", 30, 0.05}}) {
    const auto scenario =
        read_scenario(folder.write("x.toml", "[lidar]\npreset = \"" + limit.preset + "\"\n"));
    ASSERT_TRUE(scenario) << scenario.error().to_line();
    const LidarParams& lidar = scenario->lidar;
    EXPECT_NEAR(std::hypot(lidar.range_sigma_m, lidar.range_sigma_ratio * limit.range_m) /
                    (limit.accuracy_m / 2),
                1, 0.03)
        << limit.preset << " at " << limit.range_m << " m";
  }
}

TEST(StatedRangeNoise, IsThatOfTheLogForEveryPreset) {
  const ::corridor::testing::ScratchFolder folder;
  for (const std::string preset : {"urg-04lx", "rplidar-a1", "utm-30lx"}) {
    double stated_m = 0;
    std::vector<double> squares_m2;
    for (const std::string world : {"paper-corridor", "rectangle", "floor"}) {
      auto scenario = read_scenario(
          folder.write("x.toml", "base = \"" + world + "\"\n[lidar]\npreset = \"" + preset +
                                     "\"\n[drive]\nstand_s = 2\nstays = true\n"));
      ASSERT_TRUE(scenario) << scenario.error().to_line();
      const SensorLog log = recorded(*scenario, 1).log;
      stated_m = log.robot.lidar.range_sigma_m;
      const auto found_m2 = square_errors_m2(*scenario, log);
      squares_m2.insert(squares_m2.end(), found_m2.begin(), found_m2.end());
    }
    const double found_m = std::sqrt(mean(squares_m2));
    EXPECT_LT(found_m, 1.4 * stated_m) << preset;
    EXPECT_GT(found_m, stated_m / 1.4) << preset;
  }
}

}  // namespace
}  // namespace corridor::simulation::testing
