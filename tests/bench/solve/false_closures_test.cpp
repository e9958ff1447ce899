#include "bench/solve/false_closures.hpp"

#include <gtest/gtest.h>

#include "bench/solve/solve_graph.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"

namespace corridor::solve {
namespace {

using formats::PoseGraph;

constexpr std::uint32_t kRound = 40;

// Three rounds of a square of 10 m, exact odometry, a closure at every pose of the later rounds.
PoseGraph rounds() {
  PoseGraph graph;
  const Eigen::Matrix3d information = Eigen::Vector3d(2500, 2500, 10000).asDiagonal();
  Pose2 T_map_base;
  for (std::uint32_t i = 0; i < 3 * kRound; ++i) {
    graph.vertices.push_back({i, T_map_base});
    const Pose2 step(1, 0, (i + 1) % 10 == 0 ? 1.5707963267948966 : 0);
    T_map_base = T_map_base * step;
    if (i + 1 < 3 * kRound) graph.edges.push_back({i, i + 1, step, information});
  }
  for (std::uint32_t i = kRound; i < 3 * kRound; ++i) {
    graph.edges.push_back({i - kRound, i, {}, information});
  }
  return graph;
}

std::unique_ptr<backend::BackEnd> gauss_newton() { return backend::make_least_squares({}); }

TEST(FalseClosures, AreThatShareOfAllClosuresAndComeBehindTheOwnEdges) {
  const PoseGraph graph = rounds();
  for (const FalsePairs pairs : {FalsePairs::kRandom, FalsePairs::kLocal, FalsePairs::kGrouped}) {
    const auto half = with_false_closures(graph, 0.5, pairs, Rng(1));
    ASSERT_TRUE(half.has_value());
    // 80 closures of the graph's own.
    ASSERT_EQ(half->edges.size(), graph.edges.size() + 80);
    for (std::size_t k = graph.edges.size(); k < half->edges.size(); ++k) {
      const PoseGraph::Edge& edge = half->edges[k];
      EXPECT_GT(edge.j, edge.i + 1);
      EXPECT_LT(edge.j, graph.vertices.size());
      EXPECT_EQ(edge.T_i_j, Pose2());
      EXPECT_TRUE(pairs != FalsePairs::kLocal || edge.j - edge.i <= kLocalReach);
    }
    EXPECT_EQ(with_false_closures(graph, 0.2, pairs, Rng(1))->edges.size(),
              graph.edges.size() + 20);
  }
}

TEST(FalseClosures, GroupsAreRunsOfSuccessivePoses) {
  const std::size_t num_own = rounds().edges.size();
  const auto planted = with_false_closures(rounds(), 0.5, FalsePairs::kGrouped, Rng(2));
  for (std::size_t k = num_own; k < planted->edges.size(); ++k) {
    if ((k - num_own) % kGroupSize == 0) continue;
    EXPECT_EQ(planted->edges[k].i, planted->edges[k - 1].i + 1);
    EXPECT_EQ(planted->edges[k].j, planted->edges[k - 1].j + 1);
  }
}

TEST(FalseClosures, AreTheSameForTheSameSeedAlone) {
  const auto pairs_of = [](std::uint64_t seed) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    const auto planted = with_false_closures(rounds(), 0.3, FalsePairs::kRandom, Rng(seed));
    for (const PoseGraph::Edge& edge : planted->edges) pairs.emplace_back(edge.i, edge.j);
    return pairs;
  };
  EXPECT_EQ(pairs_of(5), pairs_of(5));
  EXPECT_NE(pairs_of(5), pairs_of(6));
}

TEST(FalseClosures, AGraphWithoutClosuresHasNoneToImitate) {
  PoseGraph graph = rounds();
  graph.edges.resize(graph.vertices.size() - 1);
  const auto planted = with_false_closures(graph, 0.1, FalsePairs::kRandom, Rng(1));
  ASSERT_FALSE(planted.has_value());
  EXPECT_EQ(planted.error().what, "no loop closures that false ones could imitate");
}

TEST(RejectionScore, IsCountedByHand) {
  // Edges 8 and 9 of ten are false; rejected are 3, 8: one of two is right, one of two is found.
  const std::vector<graph::FactorId> rejected{3, 8};
  EXPECT_EQ(score_of(rejected, 8, 10).precision, 0.5);
  EXPECT_EQ(score_of(rejected, 8, 10).recall, 0.5);
  EXPECT_EQ(score_of({}, 8, 10).precision, std::nullopt);
  EXPECT_EQ(score_of({}, 8, 10).recall, 0.0);
  EXPECT_EQ(score_of(rejected, 10, 10).precision, std::nullopt);
  EXPECT_EQ(score_of(rejected, 10, 10).recall, std::nullopt);
}

// Odometry is exact, so that what is left after a perfect rejection is exact too. With this seed no
// planted closure is true by chance, a multiple of a round long.
TEST(SolveGraph, EveryMethodRejectsThePlantedClosuresAndNoOther) {
  const PoseGraph own = rounds();
  const auto planted = with_false_closures(own, 0.3, FalsePairs::kRandom, Rng(4));
  for (std::size_t k = own.edges.size(); k < planted->edges.size(); ++k) {
    ASSERT_NE((planted->edges[k].j - planted->edges[k].i) % kRound, 0u);
  }
  SolveOptions options;
  options.make_back_end = gauss_newton;
  options.num_planted = planted->edges.size() - own.edges.size();
  const auto expect_perfect = [&] {
    const auto back_end = gauss_newton();
    const auto run = solve_graph(*planted, *back_end, options);
    ASSERT_TRUE(run.has_value() && run->rejected.has_value());
    const RejectionScore score = score_of(*run->rejected, own.edges.size(), planted->edges.size());
    EXPECT_EQ(score.precision, 1.0);
    EXPECT_EQ(score.recall, 1.0);
    EXPECT_LT(*run->chi2, 1.0);
  };
  for (const Rejection rejection :
       {Rejection::kGnc, Rejection::kGncGemanMcClure, Rejection::kPcm}) {
    options.rejection = rejection;
    expect_perfect();
  }
  options.rejection = Rejection::kNone;
  options.kernel = {graph::KernelKind::kDcs, 1};
  expect_perfect();
}

TEST(SolveGraph, WithoutAMethodNothingIsRejectedAndPlantedEdgesStayOutOfChi2) {
  const PoseGraph own = rounds();
  const auto planted = with_false_closures(own, 0.1, FalsePairs::kRandom, Rng(3));
  const auto back_end = gauss_newton();
  const auto run =
      solve_graph(*planted, *back_end, {.num_planted = planted->edges.size() - own.edges.size()});
  ASSERT_TRUE(run.has_value());
  EXPECT_FALSE(run->rejected.has_value());
  EXPECT_LT(*run->chi2, *run->cost);
}

}  // namespace
}  // namespace corridor::solve
