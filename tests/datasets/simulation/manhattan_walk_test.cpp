#include "datasets/simulation/manhattan_walk.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/formats/graphs/pose_graph_file.hpp"

namespace corridor::simulation {
namespace {

TEST(ManhattanWalk, GivesTheSameGraphForTheSameNameAndAnotherForAnotherSeed) {
  const auto text = [](std::uint64_t seed) {
    return formats::pose_graph_text(walk_graph({200, seed}).graph, formats::GraphFormat::kG2o);
  };
  EXPECT_EQ(text(1), text(1));
  EXPECT_NE(text(1), text(2));
}

TEST(ManhattanWalk, MeasuresTheTrueWayWithTheNoiseItStates) {
  const WalkGraph walk = walk_graph({5000, 3});
  ASSERT_EQ(walk.graph.vertices.size(), 5000U);
  ASSERT_EQ(walk.true_poses.size(), 5000U);
  EXPECT_GT(walk.graph.edges.size(), 6000U);
  double chi2 = 0;
  for (const formats::PoseGraph::Edge& edge : walk.graph.edges) {
    const Pose2 true_T_i_j = walk.true_poses[edge.i].between(walk.true_poses[edge.j]);
    const Eigen::Vector3d error = edge.T_i_j.minus(true_T_i_j);
    chi2 += error.dot(edge.information * error);
  }
  // Three degrees of freedom an edge; 5 sigma of the mean of that many.
  const double mean = chi2 / static_cast<double>(walk.graph.edges.size());
  EXPECT_NEAR(mean, 3, 5 * std::sqrt(6 / static_cast<double>(walk.graph.edges.size())));
}

TEST(ManhattanWalk, StartsWhereItsOdometryLeads) {
  const WalkGraph walk = walk_graph({300, 1});
  for (const formats::PoseGraph::Edge& edge : walk.graph.edges) {
    if (edge.j != edge.i + 1) continue;
    const Pose2 predicted = walk.graph.vertices[edge.i].T_map_base * edge.T_i_j;
    EXPECT_LT(predicted.minus(walk.graph.vertices[edge.j].T_map_base).norm(), 1e-12);
  }
}

TEST(ManhattanWalk, HasOneNameForEachGraph) {
  const auto name = walk_name_from("walk-1000-s7");
  ASSERT_TRUE(name.has_value());
  EXPECT_EQ(name->num_poses, 1000U);
  EXPECT_EQ(name->seed, 7U);
  for (const char* other : {"walk", "walk-1000", "walk-1000-s", "walk-01000-s7", "walk-1000-s07",
                            "walk-1-s1", "walk-1000001-s1", "walk-1000-s7.g2o", "walk--5-s1",
                            "walk-99999999999-s1", "walk-10-s99999999999999999999"}) {
    EXPECT_FALSE(walk_name_from(other).has_value()) << other;
  }
}

}  // namespace
}  // namespace corridor::simulation
