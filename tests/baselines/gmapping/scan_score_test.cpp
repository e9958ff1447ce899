#include "baselines/gmapping/scan_score.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "slam/core/rng.hpp"

namespace corridor::gmapping {
namespace {

// Single-precision coordinates of a few metres.
constexpr double kFloatRelative = 1e-4;

ScanPoints one_point(float x_m, float y_m) { return {{x_m}, {y_m}}; }

EndPointMap map_of(const ScanPoints& points) {
  EndPointMap map(0.05);
  map.insert(points, Pose2());
  return map;
}

// The definition, in double precision and without blocks or tiles.
double plain_sum(const EndPointMap& map, const ScanPoints& points, const Pose2& T_map_base,
                 int kernel_cells, double (*term)(double nearest_m2)) {
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d p = T_map_base * Eigen::Vector2d(points.x_base_m[i], points.y_base_m[i]);
    double nearest_m2 = -1;
    const int column = static_cast<int>(std::floor(p.x() / 0.05));
    const int row = static_cast<int>(std::floor(p.y() / 0.05));
    for (int c = column - kernel_cells; c <= column + kernel_cells; ++c) {
      for (int r = row - kernel_cells; r <= row + kernel_cells; ++r) {
        if (map.hits(c, r) == 0) continue;
        const double d_m2 = (map.mean_m(c, r).cast<double>() - p).squaredNorm();
        if (nearest_m2 < 0 || d_m2 < nearest_m2) nearest_m2 = d_m2;
      }
    }
    sum += term(nearest_m2);
  }
  return sum;
}

TEST(ScanScore, OfAHitAtOneCentimetreIsExpOfMinusSquareOverSigma) {
  const EndPointMap map = map_of(one_point(1.025F, 0.525F));
  EXPECT_NEAR(scan_score(map, one_point(1.035F, 0.525F), Pose2(), {}), std::exp(-1e-4 / 0.05),
              1e-5);
}

TEST(ScanScore, CountsTheNearestOfSeveralCells) {
  const EndPointMap map = map_of({{1.025F, 1.075F}, {0.525F, 0.525F}});
  EXPECT_NEAR(scan_score(map, one_point(1.045F, 0.525F), Pose2(), {}), std::exp(-4e-4 / 0.05),
              1e-5);
}

TEST(ScanScore, IsExactlyZeroWithoutACellInTheNeighbourhood) {
  const EndPointMap map = map_of(one_point(1.0F, 0.5F));
  EXPECT_EQ(scan_score(map, one_point(3.0F, 0.5F), Pose2(), {}), 0.0);
  EXPECT_EQ(scan_score(EndPointMap(0.05), one_point(3.0F, 0.5F), Pose2(), {}), 0.0);
}

TEST(ScanScore, OfAScanWithoutPointsIsZero) {
  EXPECT_EQ(scan_score(map_of(one_point(1, 1)), ScanPoints{}, Pose2(), {}), 0.0);
  EXPECT_EQ(scan_log_likelihood(map_of(one_point(1, 1)), ScanPoints{}, Pose2(), {}), 0.0);
}

TEST(ScanScore, OfAScanOnItsOwnMapIsTheNumberOfItsPoints) {
  ScanPoints points;
  for (int i = 0; i < 100; ++i) {
    points.x_base_m.push_back(0.2F * static_cast<float>(i) + 0.01F);
    points.y_base_m.push_back(2.0F);
  }
  EXPECT_NEAR(scan_score(map_of(points), points, Pose2(), {}), 100, 1e-3);
}

TEST(ScanLogLikelihood, OfHitsAndMissesEqualsTheHandComputedSum) {
  const EndPointMap map = map_of(one_point(1.025F, 0.525F));
  const ScanPoints points{{1.035F, 5.0F, 1.025F}, {0.525F, 5.0F, 0.545F}};
  EXPECT_NEAR(scan_log_likelihood(map, points, Pose2(), {}), -(1e-4 + 0.5 + 4e-4) / 0.075, 1e-4);
}

TEST(ScanScore, SearchesOnlyTheOwnCellForAKernelOfZero) {
  const EndPointMap map = map_of(one_point(1.049F, 0.525F));
  GmappingParams params;
  params.kernel_size_cells = 0;
  EXPECT_EQ(scan_score(map, one_point(1.051F, 0.525F), Pose2(), params), 0.0);
  params.kernel_size_cells = 1;
  EXPECT_GT(scan_score(map, one_point(1.051F, 0.525F), Pose2(), params), 0.99);
}

RC_GTEST_PROP(ScanScore, EqualsThePlainDefinition, (std::uint64_t seed)) {
  Rng rng(seed);
  const auto random_points = [&rng](std::size_t count) {
    ScanPoints points;
    for (std::size_t i = 0; i < count; ++i) {
      points.x_base_m.push_back(static_cast<float>(rng.uniform(-3, 3)));
      points.y_base_m.push_back(static_cast<float>(rng.uniform(-3, 3)));
    }
    return points;
  };
  const EndPointMap map = map_of(random_points(3000));
  const ScanPoints points = random_points(1 + rng.below(200));
  const Pose2 pose(rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5), rng.uniform(-3, 3));
  GmappingParams params;
  params.kernel_size_cells = static_cast<int>(rng.below(3));
  const double score = plain_sum(map, points, pose, params.kernel_size_cells, [](double d_m2) {
    return d_m2 < 0 ? 0.0 : std::exp(-d_m2 / 0.05);
  });
  const double log_likelihood =
      plain_sum(map, points, pose, params.kernel_size_cells,
                [](double d_m2) { return -(d_m2 < 0 ? 0.5 : d_m2) / 0.075; });
  // A point within rounding of a cell border may see another neighbourhood: 1 of 20 000 here.
  const double border_slack = 1.0;
  RC_ASSERT(std::abs(scan_score(map, points, pose, params) - score) <=
            kFloatRelative * score + border_slack);
  RC_ASSERT(std::abs(scan_log_likelihood(map, points, pose, params) - log_likelihood) <=
            kFloatRelative * std::abs(log_likelihood) + border_slack * 0.5 / 0.075);
}

// A wall along y at x = 1 seen from the left, with a second layer of hits behind its face.
TEST(ScanScore, WithAFreeFrontAskedForLooksAtTheFaceOfAWallOnly) {
  ScanPoints face{{1.01F}, {0.525F}, {1.0F}, {0.0F}};
  ScanPoints both{{1.01F, 1.06F}, {0.525F, 0.525F}, {1.0F, 1.0F}, {0.0F, 0.0F}};
  const EndPointMap map = map_of(both);
  GmappingParams params;
  params.require_free_front = true;
  // On the second layer; the cell before it holds the first.
  const ScanPoints behind{{1.06F}, {0.525F}, {1.0F}, {0.0F}};
  EXPECT_NEAR(scan_score(map, behind, Pose2(), {}), 1, 1e-6);
  EXPECT_NEAR(scan_score(map, behind, Pose2(), params), std::exp(-0.05 * 0.05 / 0.05), 1e-4);
  EXPECT_NEAR(scan_score(map, face, Pose2(), params), 1, 1e-6);
}

TEST(ScanScore, TheFrontTurnsWithThePose) {
  const ScanPoints wall{{1.01F, 1.06F}, {0.525F, 0.525F}, {1.0F, 1.0F}, {0.0F, 0.0F}};
  GmappingParams params;
  params.require_free_front = true;
  // Seen from the other side the second layer is the face.
  const Pose2 turned(0, 0, std::numbers::pi);
  const ScanPoints from_the_right{{-1.06F}, {-0.525F}, {1.0F}, {0.0F}};
  EXPECT_NEAR(scan_score(map_of(wall), from_the_right, turned, params), 1, 1e-6);
}

}  // namespace
}  // namespace corridor::gmapping
