#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/LU>
#include <memory>
#include <numbers>

#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/backend/gauss_newton/normal_equations.hpp"
#include "slam/core/rng.hpp"
#include "slam/graph/factors/pose_factors.hpp"
#include "tests/slam/backend/ring_problem.hpp"

namespace corridor::backend {
namespace {

using graph::NewFactor;
using graph::pose_key;
using testing::edge;
using testing::largest_difference;
using testing::PoseGraph;
using testing::prior;
using testing::ring;

// Both solvers stop at a relative decrease of 1e-12 in these tests.
constexpr double kSameOptimum = 1e-6;

LeastSquaresParams exact(bool use_damping) {
  LeastSquaresParams params;
  params.use_damping = use_damping;
  params.max_iterations = 100;
  params.min_relative_decrease = 1e-12;
  return params;
}

// Feeds step by step; the estimate after the last update and a final solve.
graph::Values solve(PoseGraph problem, const LeastSquaresParams& params, bool incrementally) {
  const auto solver = make_least_squares(params);
  for (std::uint32_t i = 0; i < problem.steps.size(); ++i) {
    graph::Values values;
    values.set_pose(i, problem.initial.pose(i));
    if (incrementally) {
      const BackEndReport report = solver->update(std::move(problem.steps[i]), values, {});
      EXPECT_NE(report.status, SolveStatus::kRankDeficient);
    } else {
      (void)solver->add(std::move(problem.steps[i]), values);
    }
  }
  EXPECT_EQ(solver->solve().status, SolveStatus::kConverged);
  return solver->estimate();
}

RC_GTEST_PROP(LeastSquares, IncrementalUpdatesEndAtTheBatchOptimum, (std::uint64_t seed)) {
  RC_ASSERT(largest_difference(solve(ring(seed), exact(false), true),
                               solve(ring(seed), exact(false), false)) < kSameOptimum);
}

RC_GTEST_PROP(LeastSquares, LevenbergEndsAtTheGaussNewtonOptimum, (std::uint64_t seed)) {
  RC_ASSERT(largest_difference(solve(ring(seed), exact(true), false),
                               solve(ring(seed), exact(false), false)) < kSameOptimum);
}

RC_GTEST_PROP(LeastSquares, BothLinearSolversTakeTheSameSteps, (std::uint64_t seed, bool damping)) {
  LeastSquaresParams params = exact(damping);
  params.linear = "cholmod";
  const graph::Values by_cholmod = solve(ring(seed), params, false);
  params.linear = "block";
  RC_ASSERT(largest_difference(by_cholmod, solve(ring(seed), params, false)) < kSameOptimum);
}

TEST(LeastSquares, SpaSettingsReachTheOptimumToo) {
  const auto solver = make_least_squares(spa_params());
  PoseGraph problem = ring(5);
  for (auto& factors : problem.steps) (void)solver->add(std::move(factors), problem.initial);
  const BackEndReport report = solver->solve();
  EXPECT_LT(report.chi2, report.chi2_initial);
  EXPECT_LT(largest_difference(solver->estimate(), solve(ring(5), exact(false), false)),
            kSameOptimum);
}

TEST(LeastSquares, GradientVanishesAtTheOptimum) {
  const graph::Values optimum = solve(ring(9), exact(false), false);
  PoseGraph problem = ring(9);
  graph::FactorGraph graph;
  NormalEquations equations;
  for (const graph::Key key : optimum.keys()) equations.add_variable(key);
  for (auto& factors : problem.steps) {
    for (NewFactor& factor : factors) {
      const graph::FactorId id = graph.add(std::move(factor));
      equations.add_factor(id, graph);
    }
  }
  equations.linearize(graph, optimum);
  EXPECT_LT(equations.gradient().norm(), 1e-3);
}

TEST(LeastSquares, MarginalCovarianceIsTheBlockOfTheInverseHessian) {
  const auto solver = make_least_squares(exact(false));
  PoseGraph problem = ring(2);
  NormalEquations equations;
  for (const graph::Key key : problem.initial.keys()) equations.add_variable(key);
  for (auto& factors : problem.steps) (void)solver->add(std::move(factors), problem.initial);
  solver->solve();
  for (graph::FactorId id = 0; id < solver->graph().end_id(); ++id) {
    equations.add_factor(id, solver->graph());
  }
  equations.linearize(solver->graph(), solver->estimate());
  const Eigen::MatrixXd hessian =
      Eigen::MatrixXd(equations.hessian().scalars()).selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd inverse = hessian.inverse();
  const int row = equations.first_row(pose_key(7));
  const auto covariance = solver->marginal_covariance(pose_key(7));
  ASSERT_TRUE(covariance.has_value());
  EXPECT_LT((*covariance - inverse.block<3, 3>(row, row)).norm(), 1e-9 * covariance->norm());
}

TEST(LeastSquares, WithoutAPriorThePosesAreUndeterminedAndStayAsTheyWere) {
  const auto solver = make_least_squares({});
  graph::Values values;
  values.set_pose(0, {});
  values.set_pose(1, {2, 0, 0});
  std::vector<NewFactor> factors;
  factors.push_back(edge(0, 1, {1, 0, 0}));
  const BackEndReport report = solver->update(std::move(factors), values, {});
  EXPECT_EQ(report.status, SolveStatus::kRankDeficient);
  EXPECT_TRUE(report.undetermined == pose_key(0) || report.undetermined == pose_key(1));
  EXPECT_EQ(solver->estimate().pose(1), Pose2(2, 0, 0));
  EXPECT_FALSE(solver->marginal_covariance(pose_key(0)).has_value());
}

TEST(LeastSquares, NamesThePoseThatIsUndetermined) {
  for (const char* const linear : {"block", "cholmod"}) {
    LeastSquaresParams params;
    params.linear = linear;
    const auto solver = make_least_squares(params);
    PoseGraph problem = ring(3);
    problem.initial.set_pose(99, {});  // no factor holds it
    for (auto& factors : problem.steps) (void)solver->add(std::move(factors), problem.initial);
    const BackEndReport report = solver->solve();
    EXPECT_EQ(report.status, SolveStatus::kRankDeficient);
    EXPECT_EQ(report.undetermined, pose_key(99));
  }
}

TEST(LeastSquares, ARemovedFactorNoLongerPulls) {
  const auto solver = make_least_squares(exact(false));
  graph::Values values;
  values.set_pose(0, {});
  values.set_pose(1, {1, 0, 0});
  std::vector<NewFactor> factors;
  factors.push_back(prior(0));
  factors.push_back(edge(0, 1, {1, 0, 0}));
  factors.push_back(edge(0, 1, {3, 0, 0}));
  const BackEndReport report = solver->update(std::move(factors), values, {});
  ASSERT_EQ(report.new_factor_ids.size(), 3u);
  solver->solve();
  EXPECT_NEAR(solver->estimate().pose(1).x_m(), 2, 1e-6);
  const std::vector<graph::FactorId> removed = {report.new_factor_ids[2]};
  (void)solver->update({}, {}, removed);
  solver->solve();
  EXPECT_NEAR(solver->estimate().pose(1).x_m(), 1, 1e-6);
}

TEST(LeastSquares, NothingToSolveIsAStatus) {
  const auto solver = make_least_squares({});
  EXPECT_EQ(solver->solve().status, SolveStatus::kEmpty);
}

}  // namespace
}  // namespace corridor::backend
