#include "bench/metrics/map_cloud.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "bench/metrics/wall_visibility.hpp"
#include "tests/bench/metrics/test_corridor.hpp"

namespace corridor::metrics {
namespace {

constexpr double kSecond = 1e-9;
constexpr double kExact = 1e-12;

// Second implementation: every point against every point.
std::vector<double> sorted_nearest_m(const PlanarCloud& from, const PlanarCloud& to) {
  std::vector<double> distances_m;
  for (const auto& a : from) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const auto& b : to)
      nearest_m = std::min(nearest_m, std::hypot(a.x() - b.x(), a.y() - b.y()));
    distances_m.push_back(nearest_m);
  }
  std::sort(distances_m.begin(), distances_m.end());
  return distances_m;
}

CloudDistances distances_by_trying_all(const PlanarCloud& a, const PlanarCloud& b) {
  const auto from_a = sorted_nearest_m(a, b);
  const auto from_b = sorted_nearest_m(b, a);
  const auto mean = [](const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  };
  const auto far = [](const std::vector<double>& values) {
    return values[(values.size() * 95 + 99) / 100 - 1];
  };
  return {(mean(from_a) + mean(from_b)) / 2, std::max(far(from_a), far(from_b))};
}

TEST(CloudDistances, AgreeWithTryingAllPairs) {
  Rng rng(1);
  for (int trial = 0; trial < 10; ++trial) {
    PlanarCloud a, b;
    const auto num_points = 1 + rng.below(400);
    for (std::uint64_t i = 0; i < num_points; ++i) a.emplace_back(rng.normal(), rng.normal());
    for (int i = 0; i < 150; ++i) b.emplace_back(rng.normal(1, 2), rng.normal());
    const auto open3d = cloud_distances(a, b);
    const auto second = distances_by_trying_all(a, b);
    ASSERT_TRUE(open3d);
    EXPECT_NEAR(open3d->chamfer_m, second.chamfer_m, kSecond);
    EXPECT_NEAR(open3d->hausdorff95_m, second.hausdorff95_m, kSecond);
  }
}

TEST(CloudDistances, AreHandComputed) {
  // From a: 0 and 3; from b: 0. Means 1.5 and 0; 95th percentiles 3 and 0.
  const auto distances = cloud_distances({{0, 0}, {3, 0}}, {{0, 0}});
  EXPECT_NEAR(distances->chamfer_m, 0.75, kExact);
  EXPECT_NEAR(distances->hausdorff95_m, 3, kExact);
}

TEST(CloudDistances, OfAnEmptyCloudAreNothing) {
  EXPECT_FALSE(cloud_distances({}, {{0, 0}}));
  EXPECT_FALSE(cloud_distances({{0, 0}}, {}));
  EXPECT_FALSE(cloud_distances({}, {}));
}

TEST(OccupiedPoints, AreTheCentresOfCellsAboveOneHalf) {
  GridMap map(0.1, {1, 2}, 3, 2);
  map.at(2, 1).log_odds = 0.1F;
  map.at(0, 0).log_odds = -0.1F;
  const auto points = occupied_points_world(map, Pose2(0, 0, 0));
  ASSERT_EQ(points.size(), 1U);
  EXPECT_NEAR((points[0] - Eigen::Vector2d(1.25, 2.15)).norm(), 0, kExact);
  const auto turned = occupied_points_world(map, Pose2(5, 0, std::acos(0.0)));
  EXPECT_NEAR((turned[0] - Eigen::Vector2d(5 - 2.15, 1.25)).norm(), 0, kExact);
}

class MapScore : public testing::Test {
 protected:
  void SetUp() override {
    Rng rng(3);
    scans_ = take_scans(world_, truth_, rng);
  }

  simulation::World world_ = simulation::make_corridor({});
  Trajectory truth_ = drive({});
  std::vector<LaserScan> scans_;
};

TEST_F(MapScore, OfAGoodMapIsAboutACellInWhateverFrame) {
  for (const Pose2& T_map_world : {Pose2(), Pose2(3, -2, 1)}) {
    const Trajectory estimate = in_frame(truth_, T_map_world);
    const auto score =
        score_map_cloud(map_at(scans_, estimate), estimate, truth_, world_, kTestRange_m);
    ASSERT_TRUE(score);
    EXPECT_LT(score->chamfer_m, 0.05);
    EXPECT_LT(score->hausdorff95_m, 0.1);
  }
}

TEST_F(MapScore, ChargesAShrunkMap) {
  const Trajectory estimate = changed(truth_, [](std::size_t, const Pose2& pose) {
    const double lost_m = std::clamp((pose.x_m() - 8) / 6, 0.0, 1.0);
    return Pose2(pose.x_m() - lost_m, pose.y_m(), pose.theta_rad());
  });
  const auto score =
      score_map_cloud(map_at(scans_, estimate), estimate, truth_, world_, kTestRange_m);
  EXPECT_GT(score->chamfer_m, 0.2);  // the second arm's two walls lie 1 m off
  EXPECT_NEAR(score->hausdorff95_m, 1, 0.1);
}

TEST_F(MapScore, OfAnUnfinishedDriveLooksOnlyAtWallsThatWereSeen) {
  Trajectory estimate;
  for (std::size_t i = 0; i < 60; ++i) ASSERT_TRUE(estimate.append(truth_[i]));
  const auto score =
      score_map_cloud(map_at(scans_, estimate), estimate, truth_, world_, kTestRange_m);
  EXPECT_LT(score->hausdorff95_m, 0.1);
}

TEST_F(MapScore, OfNothingIsNothing) {
  EXPECT_FALSE(score_map_cloud({}, truth_, truth_, world_, kTestRange_m));
  EXPECT_FALSE(score_map_cloud(map_at(scans_, truth_), {}, truth_, world_, kTestRange_m));
  EXPECT_FALSE(score_map_cloud(map_at(scans_, truth_), truth_, truth_, world_, 0.1));
}

TEST(WallVisibility, SeesWithinRangeAndNotThroughWalls) {
  simulation::World world;
  world.walls = {{{1, -1}, {1, 1}}, {{3, -5}, {3, 5}}};
  const auto points = sample_walls(world, 0.5);
  ASSERT_EQ(points.size(), 4U + 20U);
  const std::vector<Pose2> poses{Pose2(0, 0, 0), Pose2(2, 0, 1)};
  const auto sightings = find_sightings(points, world, poses, 3.5);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Eigen::Vector2d p = points[k].point_world_m;
    std::vector<std::uint32_t> expected;
    // From the origin the near wall hides all of the far one within |y| < 3, and the rest is out of
    // range.
    if (p.x() == 1) expected = {0, 1};
    if (p.x() == 3 && std::hypot(1, p.y()) <= 3.5) expected = {1};
    EXPECT_EQ(sightings[k], expected) << p.transpose();
  }
}

TEST(WritePly, HoldsEveryPoint) {
  const auto path = std::filesystem::path(testing::TempDir()) / "cloud.ply";
  ASSERT_TRUE(write_ply({{1, 2}, {3, 4}, {5, 6}}, path));
  std::ifstream file(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  EXPECT_TRUE(text.starts_with("ply"));
  EXPECT_NE(text.find("element vertex 3"), std::string::npos);
  std::filesystem::remove(path);
}

TEST(WritePly, ThatCannotBeWrittenIsAnError) {
  const auto written =
      write_ply({{1, 2}}, std::filesystem::path(testing::TempDir()) / "no" / "x.ply");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().to_line().find("x.ply"), std::string::npos);
  EXPECT_FALSE(write_ply({}, std::filesystem::path(testing::TempDir()) / "empty.ply"));
}

}  // namespace
}  // namespace corridor::metrics
