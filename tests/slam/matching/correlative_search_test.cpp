#include "slam/matching/correlative_search.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/support/synthetic_scan.hpp"

namespace corridor::matching {
namespace {

RC_GTEST_PROP(CorrelativeSearch, FindsADisplacedScanWithinAStep, (std::uint64_t seed)) {
  Rng rng(seed);
  const CorrelativeParams params;
  const auto walls = testing::room();
  const LaserScan reference = testing::scan_of(walls, {}, 30, 0.01, rng);
  const Pose2 truth(rng.uniform(-0.8, 0.8), rng.uniform(-0.8, 0.8), rng.uniform(-0.3, 0.3));
  const LaserScan scan = testing::scan_of(walls, truth, 30, 0.01, rng);
  const SurfaceImage image(testing::points_of(reference), params);
  const CorrelativeResult found = search(image, testing::points_of(scan), {}, 1.0, 0.4, params);
  RC_ASSERT(std::abs(found.T_map_base.x_m() - truth.x_m()) < 2 * params.resolution_m);
  RC_ASSERT(std::abs(found.T_map_base.y_m() - truth.y_m()) < 2 * params.resolution_m);
  RC_ASSERT(std::abs(found.T_map_base.theta_rad() - truth.theta_rad()) < 2 * params.angle_step_rad);
}

TEST(CorrelativeSearch, KeepsTheCentreWhenNothingTellsPlacesApart) {
  const std::vector<Eigen::Vector2d> nothing;
  const SurfaceImage image(nothing, {});
  const std::vector<Eigen::Vector2d> points = {{1, 0}, {0, 1}};
  const Pose2 centre(3, 4, 0.5);
  const CorrelativeResult found = search(image, points, centre, 0.5, 0.2, {});
  EXPECT_EQ(found.T_map_base, centre);
  EXPECT_EQ(found.score, 0);
}

TEST(CorrelativeSearch, WithoutPointsReturnsTheCentre) {
  const std::vector<Eigen::Vector2d> surface = {{0, 0}};
  const SurfaceImage image(surface, {});
  EXPECT_EQ(search(image, {}, {1, 2, 3}, 1, 1, {}).T_map_base, Pose2(1, 2, 3));
}

TEST(SurfaceImage, FallsOffWithTheDistanceToTheSurface) {
  CorrelativeParams params;
  params.resolution_m = 0.01;
  params.smear_m = 0.1;
  const std::vector<Eigen::Vector2d> surface = {{2.005, 1.005}};
  const SurfaceImage image(surface, params);
  const auto value = [&](double x, double y) {
    const Eigen::Vector2d cell = (Eigen::Vector2d(x, y) - image.origin_m()) / params.resolution_m;
    return image.at(static_cast<int>(cell.x()), static_cast<int>(cell.y()));
  };
  EXPECT_NEAR(value(2.005, 1.005), 255, 2);
  EXPECT_NEAR(value(2.105, 1.005), 255 * std::exp(-0.5),
              12);  // a cell of 1 cm at a slope of 1.5 / mm
  EXPECT_EQ(value(2.405, 1.005), 0);
}

}  // namespace
}  // namespace corridor::matching
