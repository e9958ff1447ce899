// Initial values from edges alone: exact without noise, and with noise chordal relaxation starts
// nearer to the optimum than chained odometry.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/backend/initialization/initialization.hpp"
#include "slam/backend/initialization/spanning_order.hpp"
#include "slam/core/rng.hpp"

namespace corridor::backend {
namespace {

using graph::pose_key;
using graph::RelativePoseError;

// Rounding over some hundred products of poses.
constexpr double kExact = 1e-8;

struct Problem {
  graph::FactorGraph graph;
  graph::Values truth;
  std::vector<std::uint32_t> held;
};

struct Noise {
  double position_m = 0, heading_rad = 0;
};

Pose2 noisy(Rng& rng, const Pose2& pose, const Noise& noise) {
  return pose * Pose2::exp({rng.normal(0, noise.position_m), rng.normal(0, noise.position_m),
                            rng.normal(0, noise.heading_rad)});
}

void add_edge(Problem& problem, std::uint32_t i, std::uint32_t j, const Noise& noise, Rng& rng) {
  const Pose2 exact = problem.truth.pose(i).between(problem.truth.pose(j));
  // Full information, not only a diagonal.
  Eigen::Matrix3d root = Eigen::Vector3d(10, 12, 40).asDiagonal();
  root(0, 1) = 2;
  root(0, 2) = 3;
  const auto error =
      rng.uniform() < 0.5 ? RelativePoseError::kComponents : RelativePoseError::kLogarithm;
  problem.graph.add(
      graph::RelativePose(pose_key(i), pose_key(j), noisy(rng, exact, noise), root, error));
}

// A drive around among 40 poses with random closures, some of them backwards, one repeated.
Problem random_drive(std::uint64_t seed, const Noise& noise) {
  Rng rng(seed);
  constexpr std::uint32_t kNumPoses = 40;
  Problem problem;
  Pose2 T_map_base(rng.normal(0, 5), rng.normal(0, 5), rng.normal(0, 1));
  for (std::uint32_t i = 0; i < kNumPoses; ++i) {
    problem.truth.set_pose(i, T_map_base);
    T_map_base = T_map_base * Pose2(1, 0, rng.normal(0.2, 0.5));
  }
  for (std::uint32_t i = 1; i < kNumPoses; ++i) {
    if (rng.uniform() < 0.5) {
      add_edge(problem, i - 1, i, noise, rng);
    } else {
      add_edge(problem, i, i - 1, noise, rng);
    }
  }
  for (int k = 0; k < 20; ++k) {
    const auto i = static_cast<std::uint32_t>(rng.below(kNumPoses));
    const auto j = static_cast<std::uint32_t>(rng.below(kNumPoses));
    if (i != j) add_edge(problem, i, j, noise, rng);
  }
  add_edge(problem, 0, kNumPoses - 1, noise, rng);
  add_edge(problem, 0, kNumPoses - 1, noise, rng);
  problem.held = {static_cast<std::uint32_t>(rng.below(kNumPoses))};
  return problem;
}

// Everywhere else than the truth but for the held poses.
graph::Values unknown(const Problem& problem) {
  graph::Values values;
  for (const graph::Key key : problem.truth.keys()) {
    const bool is_held =
        std::find(problem.held.begin(), problem.held.end(), key.index) != problem.held.end();
    values.set_pose(key.index, is_held ? problem.truth.pose(key.index) : Pose2(77, -5, 2));
  }
  return values;
}

double largest_difference(const graph::Values& a, const graph::Values& b) {
  double largest = 0;
  for (const graph::Key key : a.keys()) {
    largest = std::max(largest, a.pose(key.index).minus(b.pose(key.index)).norm());
  }
  return largest;
}

RC_GTEST_PROP(Initialization, BothAreExactWithoutNoise, (std::uint64_t seed)) {
  Problem problem = random_drive(seed, {});
  if (seed % 2 == 0) problem.held.push_back((problem.held.front() + 7) % 40);
  const auto odometry = odometry_initialization(problem.graph, unknown(problem), problem.held);
  const auto chordal = chordal_initialization(problem.graph, unknown(problem), problem.held);
  RC_ASSERT(odometry.has_value() && chordal.has_value());
  RC_ASSERT(largest_difference(*odometry, problem.truth) < kExact);
  RC_ASSERT(largest_difference(*chordal, problem.truth) < kExact);
}

TEST(Initialization, ChordalStartsNearerToTheOptimumThanOdometry) {
  constexpr int kNumDrives = 20;
  for (std::uint64_t seed = 1; seed <= kNumDrives; ++seed) {
    const Problem problem = random_drive(seed, {0.1, 0.1});
    const graph::Values start = unknown(problem);
    const graph::Values odometry = *odometry_initialization(problem.graph, start, problem.held);
    const graph::Values chordal = *chordal_initialization(problem.graph, start, problem.held);
    EXPECT_LT(problem.graph.chi2(chordal), problem.graph.chi2(odometry)) << seed;
  }
}

TEST(Initialization, ChordalPositionsAreTheBestForItsHeadings) {
  const Problem problem = random_drive(3, {0.1, 0.1});
  graph::Values chordal = *chordal_initialization(problem.graph, unknown(problem), problem.held);
  const double best = problem.graph.chi2(chordal);
  Rng rng(4);
  for (const graph::Key key : chordal.keys()) {
    if (key.index == problem.held.front()) continue;
    graph::Values moved = chordal;
    const Eigen::Vector3d step(rng.normal(0, 1e-3), rng.normal(0, 1e-3), 0);
    moved.retract(key, step.data());
    EXPECT_GT(problem.graph.chi2(moved), best);
  }
}

TEST(Initialization, HeldPosesStay) {
  Problem problem = random_drive(5, {0.1, 0.1});
  problem.held = {3, 20};
  const graph::Values start = unknown(problem);
  for (const auto& values : {odometry_initialization(problem.graph, start, problem.held),
                             chordal_initialization(problem.graph, start, problem.held)}) {
    ASSERT_TRUE(values.has_value());
    EXPECT_EQ(values->pose(3), start.pose(3));
    EXPECT_EQ(values->pose(20), start.pose(20));
  }
}

TEST(Initialization, APoseThatCannotBeReachedIsNamed) {
  Problem problem = random_drive(1, {});
  problem.truth.set_pose(50, {});
  problem.truth.set_pose(51, {});
  Rng rng(1);
  add_edge(problem, 50, 51, {}, rng);
  const auto odometry = odometry_initialization(problem.graph, problem.truth, {});
  ASSERT_FALSE(odometry.has_value());
  EXPECT_EQ(odometry.error().what, "pose 50 cannot be reached from pose 0 (2 of 42 poses cannot)");
  EXPECT_FALSE(chordal_initialization(problem.graph, problem.truth, {}).has_value());
  // Held in both parts, both are reached.
  const std::vector<std::uint32_t> held = {0, 51};
  EXPECT_TRUE(odometry_initialization(problem.graph, problem.truth, held).has_value());
  EXPECT_TRUE(chordal_initialization(problem.graph, problem.truth, held).has_value());
}

TEST(Initialization, ChordalNamesAPoseThatNoInformationDetermines) {
  graph::FactorGraph graph;
  graph::Values values;
  for (std::uint32_t i = 0; i < 3; ++i) values.set_pose(i, {});
  Eigen::Matrix3d root = Eigen::Matrix3d::Identity();
  graph.add(graph::RelativePose(pose_key(0), pose_key(1), {}, root));
  root(1, 1) = 0;
  graph.add(graph::RelativePose(pose_key(1), pose_key(2), {}, root));
  const auto chordal = chordal_initialization(graph, values, {});
  ASSERT_FALSE(chordal.has_value());
  EXPECT_EQ(chordal.error().what, "pose 2 is undetermined");
}

TEST(SpanningOrder, OfADriveIsTheDrive) {
  const Problem problem = random_drive(2, {});
  const auto order = spanning_order(problem.graph, problem.truth, {});
  ASSERT_TRUE(order.has_value());
  for (std::uint32_t i = 0; i < order->size(); ++i) {
    EXPECT_EQ((*order)[i].pose, i);
    if (i == 0) continue;
    EXPECT_EQ((*order)[i].parent(), i - 1);
  }
}

TEST(SpanningOrder, APoseWithoutAnEarlierNeighbourWaitsForOne) {
  Problem problem;
  for (std::uint32_t i = 0; i < 4; ++i) problem.truth.set_pose(i, Pose2(i, 0, 0));
  Rng rng(1);
  for (const auto& [i, j] :
       std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 2}, {3, 2}, {1, 3}}) {
    add_edge(problem, i, j, {}, rng);
  }
  const auto order = spanning_order(problem.graph, problem.truth, {});
  ASSERT_TRUE(order.has_value());
  std::vector<std::uint32_t> poses;
  for (const Placement& step : *order) poses.push_back(step.pose);
  EXPECT_EQ(poses, (std::vector<std::uint32_t>{0, 2, 3, 1}));
  EXPECT_LT((*order)[3].T_parent_pose().minus(Pose2(-2, 0, 0)).norm(), kExact);
}

}  // namespace
}  // namespace corridor::backend
