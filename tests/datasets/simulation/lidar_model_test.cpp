#include "datasets/simulation/lidar_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/datasets/simulation/simulation_support.hpp"

namespace corridor::simulation::testing {
namespace {

constexpr double kExact = 1e-12;
constexpr double kDegree_rad = std::numbers::pi / 180;
constexpr double kFloat_m = 1e-6;  // ranges of some metres are stored as float
constexpr std::size_t kManyBeams = 20000;

Sweep sweep_at(const World& world, const LidarParams& params, const Pose2& T_world_base) {
  return LidarModel(world, params).sweep([&](double) { return T_world_base; }, {});
}

// So many beams that all met the same.
Sweep sweep_of(std::size_t num_beams, const BeamHit& hit) {
  return {.hits = std::vector<std::optional<BeamHit>>(num_beams, hit),
          .ranges_m = std::vector<double>(num_beams, hit.range_m),
          .other_ranges_m = std::vector<double>(num_beams, 0.0)};
}

class LidarInAWideCorridor : public ::testing::Test {
 protected:
  const World world_ = make_corridor({});
  const Pose2 T_world_base_{10, 2.3, 0.4};
};

TEST_F(LidarInAWideCorridor, BeamsPointHalfAnIncrementPastMinusPi) {
  const LaserScan scan =
      LidarModel(world_, {}).measure(sweep_at(world_, {}, T_world_base_), Rng(1));
  ASSERT_EQ(scan.num_beams(), 360u);
  const double degree_rad = std::numbers::pi / 180;
  EXPECT_NEAR(scan.angle_rad(0), -179.5 * degree_rad, kExact);
  EXPECT_NEAR(scan.angle_rad(359), 179.5 * degree_rad, kExact);
}

TEST_F(LidarInAWideCorridor, NoiselessEndPointsLieOnTheWalls) {
  LidarParams params;
  params.range_sigma_m = 0;
  const LaserScan scan =
      LidarModel(world_, params).measure(sweep_at(world_, params, T_world_base_), Rng(1));
  for (std::size_t i = 0; i < scan.num_beams(); ++i) {
    if (!scan.is_valid[i]) continue;
    // Ranges are stored as float.
    EXPECT_LT(clearance_m(world_, T_world_base_ * scan.point_base_m(i)), 1e-6) << "beam " << i;
  }
}

TEST_F(LidarInAWideCorridor, RangeNoiseIsWhiteWithTheStatedSigma) {
  const LidarParams params{.range_max_m = 100};
  const LidarModel lidar(world_, params);
  const Sweep sweep = sweep_at(world_, params, T_world_base_);
  const auto& hits = sweep.hits;
  std::vector<double> errors_m;
  for (std::uint64_t scan_index = 0; scan_index < 100; ++scan_index) {
    const LaserScan scan = lidar.measure(sweep, Rng(7).stream(scan_index));
    for (std::size_t i = 0; i < hits.size(); ++i) {
      errors_m.push_back(scan.ranges_m[i] - hits[i]->range_m);
    }
  }
  EXPECT_NEAR(standard_deviation(errors_m), 0.015, 0.015 * five_sigma(errors_m.size()));
  EXPECT_NEAR(mean(errors_m), 0, 5 * 0.015 / std::sqrt(static_cast<double>(errors_m.size())));
}

TEST_F(LidarInAWideCorridor, BeamWithoutReturnIsOneMetreBeyondTheRangeAndInvalid) {
  const LidarParams params;
  const LidarModel lidar(world_, params);
  const Sweep sweep = sweep_at(world_, params, T_world_base_);
  const auto& hits = sweep.hits;
  const LaserScan scan = lidar.measure(sweep, Rng(1));
  std::size_t num_without = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i]) continue;
    ++num_without;
    EXPECT_EQ(scan.is_valid[i], 0);
    EXPECT_EQ(scan.ranges_m[i], 5.5f);
  }
  EXPECT_GT(num_without, 100u);
}

TEST_F(LidarInAWideCorridor, NoiseOfABeamDoesNotDependOnTheRange) {
  const LidarParams near{.range_max_m = 4.5};
  const LidarParams far{.range_max_m = 12};
  const LaserScan near_scan =
      LidarModel(world_, near).measure(sweep_at(world_, near, T_world_base_), Rng(3));
  const LaserScan far_scan =
      LidarModel(world_, far).measure(sweep_at(world_, far, T_world_base_), Rng(3));
  for (std::size_t i = 0; i < near_scan.num_beams(); ++i) {
    if (near_scan.is_valid[i]) {
      EXPECT_EQ(near_scan.ranges_m[i], far_scan.ranges_m[i]);
    }
  }
}

TEST(LidarNoise, NoisyRangePastTheLimitIsNoReturn) {
  const LidarParams params{.num_beams = 4, .range_max_m = 4.5, .range_sigma_m = 0.015};
  const World nothing;
  const LidarModel lidar(nothing, params);
  const Sweep sweep = sweep_of(4, {.range_m = 4.4999});
  int num_valid = 0;
  for (std::uint64_t k = 0; k < 500; ++k) {
    const LaserScan scan = lidar.measure(sweep, Rng(1).stream(k));
    for (std::size_t i = 0; i < 4; ++i) {
      num_valid += scan.is_valid[i];
      if (scan.is_valid[i]) {
        EXPECT_LE(scan.ranges_m[i], 4.5f);
      }
    }
  }
  EXPECT_NEAR(num_valid / 2000.0, 0.5, 5 * 0.5 / std::sqrt(2000.0));
}

// Standard deviation of many readings of one hit.
double noise_of(const LidarParams& params, const BeamHit& hit) {
  const World nothing;
  const LidarModel lidar(nothing, params);
  const LaserScan scan = lidar.measure(sweep_of(kManyBeams, hit), Rng(11));
  return standard_deviation({scan.ranges_m.begin(), scan.ranges_m.end()});
}

TEST(LidarNoise, GrowsWithTheRange) {
  LidarParams params{.range_max_m = 20, .range_sigma_m = 0.01};
  params.range_sigma_ratio = 0.005;
  for (const double range_m : {1.0, 4.0, 12.0}) {
    const double sigma_m = std::hypot(0.01, 0.005 * range_m);
    EXPECT_NEAR(noise_of(params, {.range_m = range_m}), sigma_m, sigma_m * five_sigma(kManyBeams))
        << range_m << " m";
  }
}

TEST(LidarNoise, GrowsWithTheTangentOfIncidenceUpToTenTimes) {
  LidarParams params{.range_sigma_m = 0.01};
  params.range_sigma_incidence_m = 0.004;
  for (const auto& [incidence_deg, tangent] :
       {std::pair(0.0, 0.0), {60.0, std::sqrt(3.0)}, {80.0, 5.6713}, {89.0, 10.0}}) {
    const double sigma_m = std::hypot(0.01, 0.004 * tangent);
    const double cosine = std::cos(incidence_deg * kDegree_rad);
    EXPECT_NEAR(noise_of(params, {.range_m = 2, .cosine = cosine}), sigma_m,
                sigma_m * five_sigma(kManyBeams))
        << incidence_deg << " deg";
  }
}

TEST_F(LidarInAWideCorridor, RangesAreWholeSteps) {
  LidarParams params{.range_sigma_m = 0};
  params.range_step_m = 0.05;
  const Sweep sweep = sweep_at(world_, params, T_world_base_);
  const LaserScan scan = LidarModel(world_, params).measure(sweep, Rng(1));
  std::vector<double> errors_m;
  for (std::size_t i = 0; i < scan.num_beams(); ++i) {
    if (!scan.is_valid[i]) continue;
    const double steps = scan.ranges_m[i] / params.range_step_m;
    EXPECT_NEAR(steps, std::round(steps), 1e-4);  // floats
    errors_m.push_back(scan.ranges_m[i] - sweep.hits[i]->range_m);
    EXPECT_LE(std::abs(errors_m.back()), 0.025 + 1e-6);
  }
  // Uniform over a step: standard deviation of the estimate about 0.45 / sqrt(n) of it.
  const double sigma_m = 0.05 / std::sqrt(12.0);
  EXPECT_NEAR(standard_deviation(errors_m), sigma_m, sigma_m * five_sigma(errors_m.size()));
}

TEST(LidarNoise, DropsTheStatedShareOfTheBeams) {
  LidarParams params;
  params.dropout_ratio = 0.07;
  const World nothing;
  const LaserScan scan =
      LidarModel(nothing, params).measure(sweep_of(kManyBeams, {.range_m = 2}), Rng(3));
  const auto num_dropped = std::count(scan.is_valid.begin(), scan.is_valid.end(), 0);
  EXPECT_NEAR(static_cast<double>(num_dropped) / kManyBeams, 0.07,
              5 * std::sqrt(0.07 * 0.93 / kManyBeams));
  for (std::size_t i = 0; i < scan.num_beams(); ++i) {
    if (!scan.is_valid[i]) {
      EXPECT_EQ(scan.ranges_m[i], 5.5f);
    }
  }
}

// A pane 2 m ahead and a wall 3 m ahead, both across the middle of the view.
TEST(LidarMaterials, GlassIsSeenSquarelyAndTheWallBehindItObliquely) {
  World world = world_of({{{2, -20}, {2, 20}}, {{3, -20}, {3, 20}}});
  world.materials = {{.name = "wall"}, {.name = "glass", .seen_within_deg = 15}};
  world.material_of_surface = {1, 0};
  const LidarParams params{.num_beams = 100, .field_of_view_deg = 100, .range_max_m = 20};
  const Sweep sweep = sweep_at(world, params, {});
  int num_on_glass = 0;
  for (int i = 0; i < params.num_beams; ++i) {
    const double angle_rad = beam_angle_rad(params, i);
    const bool is_square = std::abs(angle_rad) < 15 * kDegree_rad;
    num_on_glass += is_square;
    EXPECT_NEAR(sweep.ranges_m[static_cast<std::size_t>(i)],
                (is_square ? 2 : 3) / std::cos(angle_rad), 1e-9);
  }
  EXPECT_EQ(num_on_glass, 30);
}

TEST(LidarMaterials, DarkWallsReturnUpToTheirShareOfTheRangeAndHideWhatIsBehind) {
  World world = world_of({{{-20, 1}, {20, 1}}, {{-20, 1.5}, {20, 1.5}}});
  world.materials = {{.name = "dark", .range_factor = 0.5}, {.name = "wall"}};
  world.material_of_surface = {0, 1};
  const LidarParams params{.num_beams = 360, .range_max_m = 4};
  const Sweep sweep = sweep_at(world, params, {});
  int num_too_far = 0;
  for (int i = 0; i < params.num_beams; ++i) {
    const double angle_rad = beam_angle_rad(params, i);
    const double to_dark_m = angle_rad > 0 ? 1 / std::sin(angle_rad) : 1e9;
    const auto& hit = sweep.hits[static_cast<std::size_t>(i)];
    EXPECT_EQ(hit.has_value(), to_dark_m <= 2) << i;
    if (hit) {
      EXPECT_NEAR(hit->range_m, to_dark_m, 1e-9);
    }
    num_too_far += to_dark_m > 2 && to_dark_m < 2.5;
  }
  EXPECT_GT(num_too_far, 5);  // whose beams would end on the wall behind, in range
}

TEST(LidarMounting, EndPointsLieOnTheWallsFromWhereItIsMounted) {
  const World world = make_corridor({});
  const LidarParams params{
      .x_m = 0.3, .y_m = -0.1, .yaw_deg = 25, .range_max_m = 30, .range_sigma_m = 0};
  const Pose2 T_world_base(10, 2.3, 0.4);
  const LaserScan scan =
      LidarModel(world, params).measure(sweep_at(world, params, T_world_base), Rng(1));
  EXPECT_NEAR(scan.T_base_lidar.theta_rad(), 25 * kDegree_rad, kExact);
  for (std::size_t i = 0; i < scan.num_beams(); ++i) {
    ASSERT_TRUE(scan.is_valid[i]);
    EXPECT_LT(clearance_m(world, T_world_base * scan.point_base_m(i)), kFloat_m) << "beam " << i;
  }
}

}  // namespace
}  // namespace corridor::simulation::testing
