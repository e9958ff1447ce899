#include "slam/backend/robust/pairwise_consistency.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>

#include "slam/backend/robust/loop_closures.hpp"
#include "tests/slam/backend/ring_problem.hpp"

namespace corridor::backend {
namespace {

using graph::FactorId;

constexpr double kTight = 1e-9;

struct Drive {
  graph::FactorGraph graph;
  graph::Values values;
};

// A straight drive with steps of 1 m, standard deviations 0.1 m, 0.1 m and 1/30 rad.
Drive straight(std::uint32_t num_poses) {
  Drive drive;
  for (std::uint32_t i = 0; i < num_poses; ++i) {
    drive.values.set_pose(i, Pose2(i, 0, 0));
    if (i > 0) drive.graph.add(testing::edge(i - 1, i, Pose2(1, 0, 0)));
  }
  return drive;
}

TEST(OdometryTree, CovarianceOfAStraightDriveIsThatComputedByHand) {
  const Drive drive = straight(5);
  const auto tree = OdometryTree::of(drive.graph, drive.values, {});
  ASSERT_TRUE(tree.has_value());
  const UncertainPose way = tree->between(1, 4);
  EXPECT_NEAR(way.T.x_m(), 3, kTight);
  // Three steps: along 3 * 0.01; heading 3 / 900; across 3 * 0.01 and the lever of the first two
  // headings, (2^2 + 1^2) / 900.
  EXPECT_NEAR(way.covariance(0, 0), 0.03, kTight);
  EXPECT_NEAR(way.covariance(1, 1), 0.03 + 5.0 / 900, kTight);
  EXPECT_NEAR(way.covariance(2, 2), 3.0 / 900, kTight);
  EXPECT_NEAR(way.covariance(1, 2), 3.0 / 900, kTight);
}

// Chained edge by edge: transported by the next step, plus its own.
RC_GTEST_PROP(OdometryTree, BetweenEqualsTheChainOfItsEdgesInBothDirections, (std::uint64_t seed)) {
  Rng rng(seed);
  Drive drive;
  UncertainPose chain;
  const std::uint32_t start = 3, end = 17;
  const Eigen::Matrix3d step_covariance = Eigen::Vector3d(0.01, 0.01, 1.0 / 900).asDiagonal();
  for (std::uint32_t i = 0; i <= end; ++i) {
    drive.values.set_pose(i, {});
    if (i == 0) continue;
    const Pose2 step(rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-3, 3));
    drive.graph.add(testing::edge(i - 1, i, step));
    if (i <= start) continue;
    chain.covariance = transport_covariance(step.inverse(), chain.covariance) + step_covariance;
    chain.T = chain.T * step;
  }
  const auto tree = OdometryTree::of(drive.graph, drive.values, {});
  const UncertainPose forth = tree->between(start, end);
  const UncertainPose back = tree->between(end, start);
  RC_ASSERT(forth.T.minus(chain.T).norm() < kTight);
  RC_ASSERT((forth.covariance - chain.covariance).norm() < kTight);
  RC_ASSERT(back.T.minus(chain.T.inverse()).norm() < kTight);
  RC_ASSERT((back.covariance - transport_covariance(chain.T, chain.covariance)).norm() < kTight);
}

TEST(Inconsistency, OfTwoClosuresOfAStandingRobotIsTheSquaredDifferenceOverAllVariances) {
  // Steps of no length, no levers: two closures that differ by 0.5 m along x; the loop has two
  // odometry steps and two closures of 0.01 m^2 each: 0.25 / 0.04.
  graph::FactorGraph graph;
  graph::Values values;
  for (std::uint32_t i = 0; i < 4; ++i) {
    values.set_pose(i, {});
    if (i > 0) graph.add(testing::edge(i - 1, i, {}));
  }
  const auto tree = OdometryTree::of(graph, values, {});
  const graph::RelativePose a = testing::edge(0, 3, {});
  const graph::RelativePose b = testing::edge(1, 2, Pose2(0.5, 0, 0));
  EXPECT_NEAR(inconsistency(a, *uncertain_pose(a), b, *uncertain_pose(b), *tree), 6.25, 1e-6);
  EXPECT_NEAR(inconsistency(a, *uncertain_pose(a), a, *uncertain_pose(a), *tree), 0, 1e-12);
}

TEST(Pcm, KeepsTheLargestSetThatAgreesAndRejectsTheRest) {
  testing::PoseGraph ring = testing::ring(1);
  Drive drive;
  drive.values = ring.initial;
  for (auto& factors : ring.steps) {
    for (graph::NewFactor& factor : factors) drive.graph.add(std::move(factor));
  }
  std::vector<FactorId> planted;
  for (std::uint32_t i = 0; i < 5; ++i) {
    planted.push_back(drive.graph.add(testing::edge(i, i + 6, Pose2(0, i, 0))));
  }
  const auto closures = loop_closures(drive.graph, drive.values, {});
  PcmParams params;
  params.inlier_probability = 0.999999;
  const auto result = pairwise_consistency(drive.graph, drive.values, {}, *closures, params);
  ASSERT_TRUE(result.has_value());
  EXPECT_TRUE(result->is_proven);
  EXPECT_EQ(result->rejected, planted);
}

TEST(Pcm, OdometryAloneRejectsNothing) {
  const Drive drive = straight(4);
  const auto result = pairwise_consistency(drive.graph, drive.values, {}, {}, PcmParams());
  ASSERT_TRUE(result.has_value());
  EXPECT_TRUE(result->rejected.empty());
}

TEST(Pcm, AnEdgeWithoutCovarianceIsNamed) {
  Drive drive = straight(4);
  const Eigen::Matrix3d weight = Eigen::Vector3d(10, 0, 30).asDiagonal();
  drive.graph.add(
      graph::RelativePose(graph::pose_key(0), graph::pose_key(3), Pose2(3, 0, 0), weight));
  const auto closures = loop_closures(drive.graph, drive.values, {});
  const auto result = pairwise_consistency(drive.graph, drive.values, {}, *closures, PcmParams());
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().what, "the edge from pose 0 to pose 3 has singular information");
}

BitGraph random_graph(Rng& rng, std::size_t num_nodes, double density) {
  BitGraph graph(num_nodes);
  for (std::size_t a = 0; a < num_nodes; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (rng.uniform() < density) graph.join(a, b);
    }
  }
  return graph;
}

bool is_clique(const BitGraph& graph, const std::vector<std::size_t>& nodes) {
  for (const std::size_t a : nodes) {
    for (const std::size_t b : nodes) {
      if (a != b && !graph.are_joined(a, b)) return false;
    }
  }
  return true;
}

RC_GTEST_PROP(MaximumClique, IsTheLargestOfAllSubsetsOfASmallGraph, (std::uint64_t seed)) {
  Rng rng(seed);
  constexpr std::size_t kNumNodes = 12;
  const BitGraph graph = random_graph(rng, kNumNodes, rng.uniform());
  std::size_t largest = 0;
  for (std::uint32_t subset = 0; subset < (1u << kNumNodes); ++subset) {
    const auto size = static_cast<std::size_t>(std::popcount(subset));
    if (size <= largest) continue;
    std::vector<std::size_t> nodes;
    for (std::size_t i = 0; i < kNumNodes; ++i) {
      if ((subset >> i) & 1u) nodes.push_back(i);
    }
    if (is_clique(graph, nodes)) largest = size;
  }
  const Clique clique = maximum_clique(graph, 1'000'000);
  RC_ASSERT(clique.is_proven);
  RC_ASSERT(clique.nodes.size() == largest);
  RC_ASSERT(is_clique(graph, clique.nodes));
}

RC_GTEST_PROP(MaximumClique, IsACliqueThatNoNodeExtendsWithoutAnySearchToo, (std::uint64_t seed)) {
  Rng rng(seed);
  const BitGraph graph = random_graph(rng, 150, 0.9);
  const Clique clique = maximum_clique(graph, 1);
  RC_ASSERT(is_clique(graph, clique.nodes));
  for (std::size_t node = 0; node < graph.num_nodes(); ++node) {
    std::vector<std::size_t> more = clique.nodes;
    if (std::count(more.begin(), more.end(), node) > 0) continue;
    more.push_back(node);
    RC_ASSERT(!is_clique(graph, more));
  }
}

TEST(MaximumClique, OfNothingIsNothingAndOfStrangersIsOne) {
  EXPECT_TRUE(maximum_clique(BitGraph(0), 10).nodes.empty());
  EXPECT_EQ(maximum_clique(BitGraph(70), 10).nodes.size(), 1u);
}

}  // namespace
}  // namespace corridor::backend
