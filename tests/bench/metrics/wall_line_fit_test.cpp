#include "bench/metrics/wall_line_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "bench/metrics/wall_slabs.hpp"
#include "bench/metrics/wall_survey.hpp"
#include "tests/bench/metrics/test_corridor.hpp"

namespace corridor::metrics {
namespace {

constexpr double kResolution_m = 0.05;
constexpr double kBand_m = 0.25;

// Hits along a 4 m wall y = offset + tan(angle) x with a known scatter, counted in cells of a grid
// that is turned by grid_angle_rad against the wall frame.
std::vector<WallCell> hit_cells(double offset_m, double angle_rad, double scatter_m,
                                double grid_angle_rad, int num_hits, Rng& rng) {
  const Pose2 T_wall_grid(0, 0, -grid_angle_rad);
  const Pose2 T_grid_wall = T_wall_grid.inverse();
  std::map<std::pair<int, int>, double> counts;
  for (int i = 0; i < num_hits; ++i) {
    const double t_m = rng.uniform(-2, 2);
    const double u_m = rng.normal(0, scatter_m);
    const Eigen::Vector2d point_grid_m =
        T_grid_wall *
        Eigen::Vector2d(t_m * std::cos(angle_rad) - u_m * std::sin(angle_rad),
                        offset_m + t_m * std::sin(angle_rad) + u_m * std::cos(angle_rad));
    counts[{static_cast<int>(std::floor(point_grid_m.x() / kResolution_m)),
            static_cast<int>(std::floor(point_grid_m.y() / kResolution_m))}] += 1;
  }
  std::vector<WallCell> cells;
  for (const auto& [cell, hits] : counts) {
    const Eigen::Vector2d centre_grid_m =
        kResolution_m * Eigen::Vector2d(cell.first + 0.5, cell.second + 0.5);
    cells.push_back({T_wall_grid * centre_grid_m, hits});
  }
  return cells;
}

// Second implementation of the model: the mean over the cell's square by the midpoint rule.
double log_likelihood_by_quadrature(const std::vector<WallCell>& cells, const WallLine& line,
                                    double grid_angle_rad) {
  constexpr int kSteps = 60;
  double sum = 0;
  for (const WallCell& cell : cells) {
    double mean = 0;
    for (int i = 0; i < kSteps; ++i) {
      for (int k = 0; k < kSteps; ++k) {
        const Eigen::Vector2d in_cell =
            kResolution_m * Eigen::Vector2d((i + 0.5) / kSteps - 0.5, (k + 0.5) / kSteps - 0.5);
        const Eigen::Vector2d point =
            cell.centre_wall_m + Pose2(0, 0, -grid_angle_rad).rotation() * in_cell;
        const double u = line.distance_m(point) / line.scatter_m;
        mean += std::exp(-0.5 * u * u) / line.scatter_m / std::sqrt(2 * std::numbers::pi) /
                (kSteps * kSteps);
      }
    }
    sum += cell.hits *
           std::log((1 - line.background_ratio) * mean + line.background_ratio / (2 * kBand_m));
  }
  const double prior = std::log(line.scatter_m / 0.012) / 0.7;
  return sum - 0.5 * prior * prior;
}

TEST(WallLineFit, LikelihoodAgreesWithQuadrature) {
  Rng rng(2);
  for (const double grid_angle_rad : {0.0, 1e-5, 0.01, 0.5, std::numbers::pi / 4, 1.5}) {
    const auto cells = hit_cells(0.03, 0.01, 0.02, grid_angle_rad, 400, rng);
    const auto line = fit_wall_line(cells, {kResolution_m, grid_angle_rad}, kBand_m);
    ASSERT_TRUE(line);
    const double second = log_likelihood_by_quadrature(cells, *line, grid_angle_rad);
    // The midpoint rule's error: (step / scatter)^2 / 24 per hit.
    EXPECT_NEAR(line->log_likelihood, second, 2e-4 * 400) << grid_angle_rad;
  }
}

TEST(WallLineFit, FindsTheMaximumOfTheLikelihood) {
  Rng rng(3);
  for (const double grid_angle_rad : {0.0, 0.3}) {
    const auto cells = hit_cells(0.03, 0.01, 0.015, grid_angle_rad, 300, rng);
    const auto best = fit_wall_line(cells, {kResolution_m, grid_angle_rad}, kBand_m);
    ASSERT_TRUE(best);
    const double at_best = log_likelihood_by_quadrature(cells, *best, grid_angle_rad);
    for (int i = 0; i < 15; ++i) {
      WallLine other = *best;
      other.offset_m += rng.normal(0, 0.004);
      other.angle_rad += rng.normal(0, 0.003);
      other.scatter_m *= std::exp(rng.normal(0, 0.2));
      EXPECT_LT(log_likelihood_by_quadrature(cells, other, grid_angle_rad), at_best + 0.05);
    }
  }
}

TEST(WallLineFit, RecoversLineScatterAndBackground) {
  Rng rng(4);
  auto cells = hit_cells(0.04, -0.02, 0.02, 0.4, 20000, rng);
  for (int i = 0; i < 1000; ++i) {
    cells.push_back({{rng.uniform(-2, 2), rng.uniform(-kBand_m, kBand_m)}, 2});
  }
  const auto line = fit_wall_line(cells, {kResolution_m, 0.4}, kBand_m);
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->offset_m, 0.04, 1e-3);
  EXPECT_NEAR(line->angle_rad, -0.02, 1e-3);
  EXPECT_NEAR(line->scatter_m, 0.02, 1e-3);
  EXPECT_NEAR(line->background_ratio, 2000.0 / 22000, 0.02);
}

TEST(WallLineFit, FarHitsHaveNoSay) {
  Rng rng(5);
  auto cells = hit_cells(0, 0, 0.015, 0.4, 5000, rng);
  const auto clean = fit_wall_line(cells, {kResolution_m, 0.4}, kBand_m);
  for (int i = 0; i < 40; ++i) cells.push_back({{0.05 * i - 1, 0.2}, 40});  // a shelf, 20 cm off
  const auto cluttered = fit_wall_line(cells, {kResolution_m, 0.4}, kBand_m);
  EXPECT_NEAR(cluttered->offset_m, clean->offset_m, 5e-4);
  EXPECT_NEAR(cluttered->angle_rad, clean->angle_rad, 5e-4);
}

TEST(WallLineFit, IsNothingWithoutTwoPlaces) {
  EXPECT_FALSE(fit_wall_line({}, {}, kBand_m));
  EXPECT_FALSE(fit_wall_line(std::vector<WallCell>{{{0, 0}, 5}}, {}, kBand_m));
  EXPECT_FALSE(fit_wall_line(std::vector<WallCell>{{{0, 0}, 5}, {{0, 0.1}, 5}}, {}, kBand_m));
}

TEST(WallLineFit, IsFiniteForTwoCellsAndForHugeCounts) {
  for (const double hits : {1e-6, 1.0, 1e9}) {
    const std::vector<WallCell> cells{{{-1, 0.01}, hits}, {{1, -0.01}, hits}};
    const auto line = fit_wall_line(cells, {}, kBand_m);
    ASSERT_TRUE(line);
    EXPECT_TRUE(std::isfinite(line->offset_m) && std::isfinite(line->angle_rad) &&
                std::isfinite(line->scatter_m) && std::isfinite(line->log_likelihood));
  }
}

// A 10 m wall, seen by a robot that drives along it at 2.5 m, drawn into grids that lie at every
// offset and angle against it: the measured line must not lean towards cell centres.
class WallInEveryGrid : public testing::Test {
 protected:
  void SetUp() override {
    world_.walls = {{{0, 0}, {10, 0}}};
    for (int i = 0; i < 50; ++i) {
      static_cast<void>(
          truth_.append({{i * 100'000'000LL}, Pose2(0.2 * i, 2.5, 0.1), std::nullopt}));
    }
    Rng rng(7);
    scans_ = take_scans(world_, truth_, rng);
  }

  // Signed distance of the measured line from the true one, at the middle of the wall, and the
  // angle.
  void expect_small_error(double offset_m, double angle_rad) const {
    const Pose2 T_map_world = Pose2(0, 0, angle_rad) * Pose2(0, offset_m, 0);
    const Trajectory estimate = in_frame(truth_, T_map_world);
    const WallSurvey survey(map_at(scans_, estimate), estimate, truth_, world_, kTestRange_m);
    const auto wall = survey.measure(whole(world_.walls[0]));
    ASSERT_TRUE(wall) << wall.error();
    const Eigen::Vector2d point_world_m = T_map_world.inverse() * wall->point_map_m;
    const double error_rad = wrap_angle(wall->direction_rad - angle_rad);
    EXPECT_LT(std::abs(point_world_m.y()), 0.005) << offset_m << " m, " << angle_rad << " rad";
    EXPECT_LT(std::abs(error_rad), 0.1 * std::numbers::pi / 180) << offset_m << ", " << angle_rad;
    EXPECT_NEAR(point_world_m.x(), 5, 1);
  }

  simulation::World world_;
  Trajectory truth_;
  std::vector<LaserScan> scans_;
};

TEST_F(WallInEveryGrid, BiasIsBelow5MillimetresAtEveryOffset) {
  for (double angle_deg : {0.0, 0.05, 0.2, 1.0, 30.0, 45.0, 90.0}) {
    for (int offset_mm = 0; offset_mm <= 50; offset_mm += 5) {
      expect_small_error(offset_mm * 1e-3, angle_deg * std::numbers::pi / 180);
    }
  }
}

TEST_F(WallInEveryGrid, BiasIsBelow5MillimetresAtEveryAngle) {
  for (int angle_deg = 0; angle_deg <= 90; angle_deg += 3) {
    for (const double offset_m : {0.0, 0.0125, 0.025}) {
      expect_small_error(offset_m, angle_deg * std::numbers::pi / 180);
    }
  }
}

// What the census of hits is for: the mean of cell centres misses the bound for walls along the
// grid.
TEST(WallLineFit, CellCentresAloneWouldBeBiased) {
  Rng rng(8);
  const double offset_m = 0.0125;  // a quarter of a cell
  const auto cells = hit_cells(offset_m, 0, 0.008, 0, 20000, rng);
  double sum = 0, sum_hits = 0;
  for (const auto& cell : cells) {
    sum += cell.hits * cell.centre_wall_m.y();
    sum_hits += cell.hits;
  }
  EXPECT_GT(std::abs(sum / sum_hits - offset_m), 0.007);
  EXPECT_LT(std::abs(fit_wall_line(cells, {kResolution_m, 0}, kBand_m)->offset_m - offset_m),
            0.003);
}

TEST(WallSlabs, VarianceIsThatOfTheSlabMeans) {
  // Three slabs of three cells each at distances 1, -2, 1 mm from the line y = 0: that is all
  // residual.
  std::vector<WallCell> cells;
  for (int slab = 0; slab < 3; ++slab) {
    for (int i = 0; i < 3; ++i) {
      cells.push_back({{0.5 * slab + 0.1 + 0.15 * i, slab == 1 ? -0.002 : 0.001}, 10});
    }
  }
  const WallLine line{0, 0, 0.02, 1e-6, 0};
  const auto slabs = slab_statistics(cells, line, {}, kBand_m, 0.5);
  EXPECT_EQ(slabs.num_slabs, 3U);
  EXPECT_NEAR(slabs.residual_variance_m2, 6e-6, 1e-10);
  EXPECT_NEAR(slabs.sum_along_m2, 0.5, 1e-12);
  EXPECT_NEAR(slabs.mean_along_m, 0.75, 1e-12);
  EXPECT_EQ(slabs.doubled_ratio, 0);
}

TEST(WallSlabs, TwoRidgesAreSeenAndOneThickRidgeIsNot) {
  Rng rng(9);
  for (const double grid_angle_rad : {0.0, 0.2, 0.8}) {
    const CellShape shape{kResolution_m, grid_angle_rad};
    const WallLine line{0, 0, 0.05, 0.01, 0};
    auto two = hit_cells(-0.1, 0, 0.015, grid_angle_rad, 4000, rng);
    for (const auto& cell : hit_cells(0.1, 0, 0.015, grid_angle_rad, 2500, rng))
      two.push_back(cell);
    EXPECT_GT(slab_statistics(two, line, shape, kBand_m, 0.5).doubled_ratio, 0.9);
    const auto thick = hit_cells(0, 0, 0.05, grid_angle_rad, 6000, rng);
    EXPECT_LT(slab_statistics(thick, line, shape, kBand_m, 0.5).doubled_ratio, 0.2);
  }
}

}  // namespace
}  // namespace corridor::metrics
