#include "slam/matching/surfel_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "slam/core/rng.hpp"

namespace corridor::matching {
namespace {

TEST(SurfelGrid, FindsMeanAndNormalOfALine) {
  Rng rng(1);
  for (const double angle : {0.0, 0.4, 1.2, 2.5}) {
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d normal(-along.y(), along.x());
    const Eigen::Vector2d through = 3.017 * normal;
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < 4000; ++i) {
      points.emplace_back(through + rng.uniform(-2, 2) * along + rng.normal(0, 0.005) * normal);
    }
    SurfelGrid grid(0.1);
    grid.insert(points);
    const Surfel* surfel = grid.find(through);
    ASSERT_NE(surfel, nullptr);
    EXPECT_NEAR(std::abs(surfel->normal.dot(normal)), 1, 1e-3);
    // About 300 points in the window, each within 5 mm: the mean lies within 5 sigma = 1.5 mm.
    EXPECT_NEAR(surfel->mean_m.dot(normal), 3.017, 1.5e-3);
    EXPECT_NEAR(surfel->normal_variance_m2, 25e-6, 10e-6);
  }
}

TEST(SurfelGrid, FewerThanThreePointsAreNoSurface) {
  SurfelGrid grid(0.1);
  const std::vector<Eigen::Vector2d> two = {{1.01, 1.01}, {1.05, 1.02}};
  grid.insert(two);
  EXPECT_EQ(grid.find({1.03, 1.01}), nullptr);
  const std::vector<Eigen::Vector2d> third = {{1.08, 1.03}};
  grid.insert(third);
  ASSERT_NE(grid.find({1.03, 1.01}), nullptr);
  EXPECT_EQ(grid.find({1.03, 1.01})->num_points, 3);
}

TEST(SurfelGrid, PoolsAcrossCellAndTileBordersOnBothSidesOfZero) {
  SurfelGrid grid(0.1);
  std::vector<Eigen::Vector2d> points;
  for (int i = -100; i <= 100; ++i) points.emplace_back(0.02 * i + 0.001, -0.8001);
  grid.insert(points);
  for (double x = -1.5; x < 1.5; x += 0.037) {
    const Surfel* surfel = grid.find({x, -0.8001});
    ASSERT_NE(surfel, nullptr) << x;
    EXPECT_NEAR(surfel->mean_m.y(), -0.8001, 1e-6);
    EXPECT_NEAR(surfel->num_points, 15, 1);  // 0.3 m of wall, a point each 2 cm
  }
}

TEST(SurfelGrid, NothingIsFoundFarFromPoints) {
  SurfelGrid grid(0.1);
  EXPECT_EQ(grid.find({0, 0}), nullptr);
  const std::vector<Eigen::Vector2d> points(5, Eigen::Vector2d(1, 1));
  grid.insert(points);
  EXPECT_EQ(grid.find({5, 5}), nullptr);
}

TEST(SurfelGrid, CellMeansAreTheMeansOfTheirPoints) {
  SurfelGrid grid(0.5);
  const std::vector<Eigen::Vector2d> points = {{0.1, 0.1}, {0.3, 0.2}, {-0.1, -0.4}};
  grid.insert(points);
  const auto means = grid.cell_means_m();
  ASSERT_EQ(means.size(), 2u);
  EXPECT_NEAR((means[0] - Eigen::Vector2d(-0.1, -0.4)).norm(), 0, 1e-6);
  EXPECT_NEAR((means[1] - Eigen::Vector2d(0.2, 0.15)).norm(), 0, 1e-6);
}

}  // namespace
}  // namespace corridor::matching
