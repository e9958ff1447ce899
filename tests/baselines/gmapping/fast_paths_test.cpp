// The score by blocks, tiles and vectors against the score by its definition, climb by climb: the
// same accepted steps up to the same pose.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <map>
#include <utility>

#include "baselines/gmapping/hill_climb.hpp"
#include "baselines/gmapping/scan_score.hpp"
#include "tests/support/synthetic_scan.hpp"

namespace corridor::gmapping {
namespace {

// Mean of the end points per cell, one point and one cell after the other. In single precision, in
// which a map is kept: a point on the edge of two cells has to fall into the same one.
class PlainMap {
 public:
  void insert(const ScanPoints& points, const Pose2& T_map_base) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2f p = at(points, i, T_map_base);
      auto& [mean_m, count] = cells_[cell_of(p)];
      ++count;
      mean_m += (p - mean_m) * (1 / count);
    }
  }

  [[nodiscard]] double score(const ScanPoints& points, const Pose2& T_map_base) const {
    double score = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2f p = at(points, i, T_map_base);
      const auto [column, row] = cell_of(p);
      double best = 0;
      for (int c = column - 1; c <= column + 1; ++c) {
        for (int r = row - 1; r <= row + 1; ++r) {
          const auto found = cells_.find({c, r});
          if (found == cells_.end()) continue;
          const double distance2_m2 = (found->second.mean_m - p).squaredNorm();
          best = std::max(best, std::exp(-distance2_m2 / 0.05));
        }
      }
      score += best;
    }
    return score;
  }

 private:
  static Eigen::Vector2f at(const ScanPoints& points, std::size_t i, const Pose2& T_map_base) {
    const auto c = static_cast<float>(std::cos(T_map_base.theta_rad()));
    const auto s = static_cast<float>(std::sin(T_map_base.theta_rad()));
    const float x_m = points.x_base_m[i];
    const float y_m = points.y_base_m[i];
    return {c * x_m - s * y_m + static_cast<float>(T_map_base.x_m()),
            s * x_m + c * y_m + static_cast<float>(T_map_base.y_m())};
  }
  static std::pair<int, int> cell_of(const Eigen::Vector2f& p) {
    return {static_cast<int>(std::floor(p.x() * 20.0F)),
            static_cast<int>(std::floor(p.y() * 20.0F))};
  }

  struct Cell {
    Eigen::Vector2f mean_m = Eigen::Vector2f::Zero();
    float count = 0;
  };
  std::map<std::pair<int, int>, Cell> cells_;
};

ScanPoints points_at(const Pose2& T_map_base, Rng& rng) {
  const LaserScan scan = testing::scan_of(testing::room(), T_map_base, 12, 0.01, rng);
  return usable_points(scan, {.max_range_m = 12, .tilt_steps = 0, .stride = 1});
}

Pose2 near(const Pose2& pose, double position_m, double heading_rad, Rng& rng) {
  return {pose.x_m() + rng.uniform(-position_m, position_m),
          pose.y_m() + rng.uniform(-position_m, position_m),
          pose.theta_rad() + rng.uniform(-heading_rad, heading_rad)};
}

struct Scene {
  explicit Scene(std::uint64_t seed) : map(0.05) {
    Rng rng(seed);
    const Pose2 truth(rng.uniform(-2, 2), rng.uniform(-1.5, 1.5), rng.uniform(-3, 3));
    for (int i = 0; i < 4; ++i) {
      const Pose2 pose = near(truth, 0.8, 1, rng);
      const ScanPoints seen = points_at(pose, rng);
      map.insert(seen, pose);
      plain_map.insert(seen, pose);
    }
    points = points_at(truth, rng);
    start = near(truth, 0.15, 0.1, rng);
  }

  EndPointMap map;
  PlainMap plain_map;
  ScanPoints points;
  Pose2 start;
};

RC_GTEST_PROP(HillClimb, MeetsTheScoreByItsDefinitionAtEveryPoseItTries, (std::uint64_t seed)) {
  const Scene scene(seed);
  (void)hill_climb(scene.start, {}, [&](const Pose2& pose) {
    const double fast = scan_score(scene.map, scene.points, pose, {});
    const double plain = scene.plain_map.score(scene.points, pose);
    // Sums of a few hundred in single precision; a point on the edge of two cells.
    RC_ASSERT(std::abs(fast - plain) < 1e-4 * plain);
    return fast;
  });
}

// Two neighbours may score alike to the last digit; then rounding decides which is taken.
TEST(HillClimb, TakesTheStepsOfTheScoreByItsDefinitionButForNearTies) {
  constexpr int kNumScenes = 100;
  int num_alike = 0;
  for (std::uint64_t seed = 1; seed <= kNumScenes; ++seed) {
    const Scene scene(seed);
    const HillClimbResult fast = hill_climb(scene.start, {}, [&](const Pose2& pose) {
      return scan_score(scene.map, scene.points, pose, {});
    });
    const HillClimbResult plain = hill_climb(scene.start, {}, [&](const Pose2& pose) {
      return scene.plain_map.score(scene.points, pose);
    });
    const bool is_alike =
        fast.T_map_base == plain.T_map_base && fast.num_evaluations == plain.num_evaluations;
    if (is_alike) ++num_alike;
    EXPECT_NEAR(fast.score, plain.score, 1e-3 * plain.score) << "seed " << seed;
  }
  EXPECT_GE(num_alike, 95);
}

}  // namespace
}  // namespace corridor::gmapping
