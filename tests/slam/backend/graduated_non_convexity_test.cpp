#include "slam/backend/robust/graduated_non_convexity.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/backend/isam2/isam2.hpp"
#include "slam/backend/robust/loop_closures.hpp"
#include "slam/core/chi_squared.hpp"
#include "tests/slam/backend/ring_problem.hpp"

namespace corridor::backend {
namespace {

using graph::FactorId;

constexpr double kSameOptimum = 1e-6;

std::unique_ptr<BackEnd> exact_gauss_newton() {
  LeastSquaresParams params;
  params.max_iterations = 100;
  params.min_relative_decrease = 1e-12;
  return make_least_squares(params);
}

struct Problem {
  graph::FactorGraph graph;
  graph::Values initial;
  std::vector<FactorId> closures, planted;
};

Problem ring_with_false_closures(std::uint64_t seed, int num_false) {
  Problem problem;
  testing::PoseGraph ring = testing::ring(seed);
  for (auto& factors : ring.steps) {
    for (graph::NewFactor& factor : factors) problem.graph.add(std::move(factor));
  }
  Rng rng(seed);
  for (int k = 0; k < num_false; ++k) {
    // Across the ring, some 4 m apart, seen as the same place.
    const auto i = static_cast<std::uint32_t>(rng.below(12));
    problem.planted.push_back(
        problem.graph.add(testing::edge(i, i + 6, testing::noisy(rng, Pose2()))));
  }
  problem.initial = ring.initial;
  problem.closures = *loop_closures(problem.graph, problem.initial, {});
  return problem;
}

graph::Values plain_optimum(const Problem& problem, const std::vector<FactorId>& left_out) {
  const auto back_end = exact_gauss_newton();
  graph::FactorGraph graph = problem.graph;
  for (const FactorId id : left_out) graph.remove(id);
  std::vector<graph::NewFactor> factors;
  graph.for_each([&](FactorId, const auto& factor, const graph::RobustKernel& kernel) {
    factors.emplace_back(factor, kernel);
  });
  (void)back_end->add(std::move(factors), problem.initial);
  EXPECT_EQ(back_end->solve().status, SolveStatus::kConverged);
  return back_end->estimate();
}

TEST(LoopClosures, AreTheEdgesOutsideTheChain) {
  const Problem problem = ring_with_false_closures(1, 2);
  // 12 of the second round, 2 planted; a prior and 23 steps are none.
  EXPECT_EQ(problem.closures.size(), 14u);
  for (const FactorId id : problem.closures) {
    const auto keys = problem.graph.keys(id);
    EXPECT_GT(keys[1].index - keys[0].index, 1u);
  }
}

TEST(GncWeight, IsThatOfEquations12And14) {
  // mu = 1: 1 up to c^2 / 2, 0 from 2 c^2 on, c / r sqrt(2) - 1 between.
  EXPECT_DOUBLE_EQ(gnc_weight(GncLoss::kTruncated, 0.5, 1), 1);
  EXPECT_DOUBLE_EQ(gnc_weight(GncLoss::kTruncated, 2, 1), 0);
  EXPECT_NEAR(gnc_weight(GncLoss::kTruncated, 1, 1), std::sqrt(2.0) - 1, 1e-15);
  EXPECT_NEAR(gnc_weight(GncLoss::kTruncated, 0.5 + 1e-12, 1), 1, 1e-10);
  EXPECT_NEAR(gnc_weight(GncLoss::kTruncated, 2 - 1e-12, 1), 0, 1e-10);
  // mu = 3, r^2 = c^2: (3 / 4)^2.
  EXPECT_DOUBLE_EQ(gnc_weight(GncLoss::kGemanMcClure, 1, 3), 0.5625);
}

RC_GTEST_PROP(GncWeight, FallsFromOneToZeroAsTheResidualGrows, (std::uint64_t seed)) {
  Rng rng(seed);
  const double mu = std::exp(rng.uniform(-20, 20));
  for (const GncLoss loss : {GncLoss::kTruncated, GncLoss::kGemanMcClure}) {
    double before = 1;
    for (double ratio = 1e-6; ratio < 1e12; ratio *= 1.5) {
      const double weight = gnc_weight(loss, ratio, mu);
      RC_ASSERT(weight >= 0 && weight <= before + 1e-12);
      before = weight;
    }
  }
}

// The bound is such that one in a million true closures is beyond it: none in these runs.
GncParams wide() {
  GncParams params;
  params.inlier_probability = 0.999999;
  return params;
}

RC_GTEST_PROP(Gnc, WithoutFalseClosuresEndsAtThePlainOptimum, (std::uint64_t seed)) {
  const Problem problem = ring_with_false_closures(seed, 0);
  for (const GncLoss loss : {GncLoss::kTruncated, GncLoss::kGemanMcClure}) {
    const GncResult result = graduated_non_convexity(
        problem.graph, problem.initial, problem.closures, loss, exact_gauss_newton, wide());
    RC_ASSERT(result.status == GncStatus::kConverged);
    RC_ASSERT(result.rejected.empty());
    RC_ASSERT(testing::largest_difference(result.values, plain_optimum(problem, {})) <
              kSameOptimum);
  }
}

RC_GTEST_PROP(Gnc, FindsExactlyThePlantedClosuresAndTheOptimumOfTheOthers, (std::uint64_t seed)) {
  const Problem problem = ring_with_false_closures(seed, 6);
  const GncResult result = graduated_non_convexity(problem.graph, problem.initial, problem.closures,
                                                   GncLoss::kTruncated, exact_gauss_newton, wide());
  RC_ASSERT(result.status == GncStatus::kConverged);
  RC_ASSERT(result.rejected == problem.planted);
  RC_ASSERT(testing::largest_difference(result.values, plain_optimum(problem, problem.planted)) <
            kSameOptimum);
}

TEST(Gnc, GemanMcClureAndOtherBackEndsFindTheSameClosures) {
  const Problem problem = ring_with_false_closures(3, 6);
  const auto rejected_by = [&](GncLoss loss, const MakeBackEnd& make_back_end) {
    return graduated_non_convexity(problem.graph, problem.initial, problem.closures, loss,
                                   make_back_end, wide())
        .rejected;
  };
  EXPECT_EQ(rejected_by(GncLoss::kGemanMcClure, exact_gauss_newton), problem.planted);
  EXPECT_EQ(rejected_by(GncLoss::kTruncated, [] { return make_isam2({}); }), problem.planted);
}

TEST(Gnc, OdometryAloneIsThePlainSolutionInOneRound) {
  Problem problem = ring_with_false_closures(4, 0);
  for (const FactorId id : problem.closures) problem.graph.remove(id);
  const GncResult result = graduated_non_convexity(
      problem.graph, problem.initial, {}, GncLoss::kTruncated, exact_gauss_newton, GncParams());
  EXPECT_EQ(result.num_rounds, 1);
  EXPECT_EQ(result.status, GncStatus::kConverged);
  EXPECT_LT(testing::largest_difference(result.values, problem.initial), kSameOptimum);
}

TEST(Gnc, WhereEveryClosureIsFalseOdometryIsLeft) {
  Problem problem = ring_with_false_closures(5, 6);
  for (const FactorId id : problem.closures) {
    if (id < problem.planted.front()) problem.graph.remove(id);
  }
  const GncResult result =
      graduated_non_convexity(problem.graph, problem.initial, problem.planted, GncLoss::kTruncated,
                              exact_gauss_newton, GncParams());
  EXPECT_EQ(result.rejected, problem.planted);
  EXPECT_LT(testing::largest_difference(result.values, problem.initial), kSameOptimum);
}

TEST(Gnc, AGraphThatNothingHoldsIsNotSolvable) {
  graph::FactorGraph graph;
  graph::Values values;
  for (std::uint32_t i = 0; i < 3; ++i) values.set_pose(i, Pose2(i, 0, 0));
  graph.add(testing::edge(0, 1, Pose2(1, 0, 0)));
  graph.add(testing::edge(1, 2, Pose2(1, 0, 0)));
  const std::vector<FactorId> closures{graph.add(testing::edge(0, 2, Pose2(1, 0, 0)))};
  const GncResult result = graduated_non_convexity(graph, values, closures, GncLoss::kTruncated,
                                                   exact_gauss_newton, GncParams());
  EXPECT_EQ(result.status, GncStatus::kNotSolvable);
  EXPECT_EQ(result.solution.status, SolveStatus::kRankDeficient);
}

}  // namespace
}  // namespace corridor::backend
