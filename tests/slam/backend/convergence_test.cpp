// update_until_converged() of every back-end.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <functional>

#include "slam/backend/ceres/ceres_back_end.hpp"
#include "slam/backend/fixed_lag/fixed_lag.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/backend/isam2/isam2.hpp"
#include "tests/slam/backend/ring_problem.hpp"

namespace corridor::backend {
namespace {

using graph::NewFactor;
using graph::pose_key;
using testing::edge;
using testing::prior;
using testing::ring;

using Make = std::function<std::unique_ptr<BackEnd>()>;

std::vector<Make> makers() {
  return {[] { return make_isam2({}); }, [] { return make_least_squares({}); },
          [] { return make_least_squares({.use_damping = true}); },
          [] { return make_fixed_lag({}); }, [] { return make_ceres({}); }};
}

void feed(BackEnd& solver, const testing::PoseGraph& problem) {
  for (std::uint32_t i = 0; i < problem.steps.size(); ++i) {
    graph::Values values;
    values.set_pose(i, problem.initial.pose(i));
    (void)solver.update(problem.steps[i], values, {});
  }
}

// All start far off, at dead reckoning with every pose thrown about.
testing::PoseGraph disturbed(std::uint64_t seed) {
  testing::PoseGraph problem = ring(seed);
  Rng rng(seed + 1);
  for (const graph::Key key : problem.initial.keys()) {
    const Pose2 there = problem.initial.pose(key.index);
    problem.initial.set_pose(key.index, testing::noisy(rng, testing::noisy(rng, there)));
  }
  return problem;
}

double optimum_of(const testing::PoseGraph& problem) {
  LeastSquaresParams params;
  params.max_iterations = 100;
  params.min_relative_decrease = 1e-14;
  const auto batch = make_least_squares(params);
  feed(*batch, problem);
  return batch->solve().chi2;
}

RC_GTEST_PROP(Convergence, ReachesTheBatchOptimumWithEveryBackEnd, (std::uint64_t seed)) {
  const testing::PoseGraph problem = disturbed(seed);
  const double optimum = optimum_of(problem);
  for (const Make& make : makers()) {
    const auto solver = make();
    feed(*solver, problem);
    const BackEndReport report = solver->update_until_converged({});
    RC_ASSERT(report.status == SolveStatus::kConverged);
    RC_ASSERT(std::abs(report.chi2 / optimum - 1) < 1e-6);
    RC_ASSERT(std::abs(solver->graph().cost(solver->estimate()) - report.chi2) < 1e-9 * optimum);
  }
}

RC_GTEST_PROP(Convergence, TheDecrementIsThatOfTheDenseNormalEquations, (std::uint64_t seed)) {
  const testing::PoseGraph problem = disturbed(seed);
  const auto incremental = make_isam2({}), batch = make_least_squares({});
  for (const auto& solver : {incremental.get(), batch.get()}) {
    for (std::uint32_t i = 0; i < problem.steps.size(); ++i) {
      graph::Values values;
      values.set_pose(i, problem.initial.pose(i));
      (void)solver->add(problem.steps[i], values);
    }
  }
  const double one = incremental->update_until_converged({1}).decrement;
  const double other = batch->update_until_converged({1}).decrement;
  RC_ASSERT(std::abs(one - other) < 1e-9 * other);
}

TEST(Convergence, TheDecrementUnderAKernelIsThatOfTheNormalEquations) {
  const auto incremental = make_isam2({}), batch = make_least_squares({});
  const testing::PoseGraph problem = disturbed(3);
  for (const auto& solver : {incremental.get(), batch.get()}) {
    for (std::uint32_t i = 0; i < problem.steps.size(); ++i) {
      graph::Values values;
      values.set_pose(i, problem.initial.pose(i));
      std::vector<NewFactor> factors = problem.steps[i];
      for (NewFactor& factor : factors) factor.kernel = {graph::KernelKind::kHuber, 0.5};
      (void)solver->add(std::move(factors), values);
    }
  }
  const double expected = batch->update_until_converged({1}).decrement;
  EXPECT_NEAR(incremental->update_until_converged({1}).decrement, expected, 1e-9 * expected);
}

TEST(Convergence, ABudgetThatIsUsedIsSaidAndTheRestComesWithTheNext) {
  for (const Make& make : makers()) {
    const auto solver = make();
    const testing::PoseGraph problem = disturbed(8);
    for (std::uint32_t i = 0; i < problem.steps.size(); ++i) {
      graph::Values values;
      values.set_pose(i, problem.initial.pose(i));
      (void)solver->add(problem.steps[i], values);
    }
    const BackEndReport first = solver->update_until_converged({1});
    EXPECT_EQ(first.status, SolveStatus::kMaxIterations) << solver->name();
    EXPECT_EQ(first.num_iterations, 1) << solver->name();
    EXPECT_LT(first.chi2, first.chi2_initial) << solver->name();
    EXPECT_EQ(solver->update_until_converged({}).status, SolveStatus::kConverged);
  }
}

// Lengths in millimetres instead of metres: the same problem, the same number of rounds.
TEST(Convergence, DoesNotDependOnUnits) {
  const auto rounds_at = [](double scale) {
    const auto solver = make_isam2({});
    const Eigen::Vector3d weight(10 / scale, 10 / scale, 30);
    const auto tie = [&](std::uint32_t i, std::uint32_t j, double x, double y, double theta) {
      return graph::RelativePose(pose_key(i), pose_key(j), Pose2(scale * x, scale * y, theta),
                                 weight.asDiagonal().toDenseMatrix());
    };
    graph::Values values;
    for (std::uint32_t i = 0; i < 4; ++i) values.set_pose(i, Pose2(scale * i, 0, 0));
    const Eigen::Matrix3d held = 100 * weight.asDiagonal().toDenseMatrix();
    (void)solver->add({graph::PosePrior(pose_key(0), {}, held), tie(0, 1, 1, 0, 1.5),
                       tie(1, 2, 1, 0, 1.5), tie(2, 3, 1, 0, 1.5), tie(3, 0, 1, 0.3, 1.3)},
                      values);
    const BackEndReport report = solver->update_until_converged({});
    EXPECT_EQ(report.status, SolveStatus::kConverged);
    return report.num_iterations;
  };
  EXPECT_EQ(rounds_at(1), rounds_at(1000));
}

TEST(Convergence, OfAnExactFitEndsThoughNoShareOfNothingIsSmall) {
  for (const Make& make : makers()) {
    const auto solver = make();
    graph::Values values;
    values.set_pose(0, {});
    values.set_pose(1, {0.9, 0.1, 0.1});
    (void)solver->add({prior(0), edge(0, 1, {1, 0, 0.2})}, values);
    const BackEndReport report = solver->update_until_converged({});
    EXPECT_EQ(report.status, SolveStatus::kConverged) << solver->name();
    EXPECT_LT(report.num_iterations, 40) << solver->name();
  }
}

TEST(Convergence, OfNothingAndOfWhatNothingHoldsIsAStatus) {
  for (const Make& make : makers()) {
    EXPECT_EQ(make()->update_until_converged({}).status, SolveStatus::kEmpty);
    const auto solver = make();
    graph::Values values;
    values.set_pose(0, {});
    values.set_pose(1, {2, 0, 0});
    (void)solver->add({prior(0)}, values);
    const BackEndReport report = solver->update_until_converged({});
    EXPECT_EQ(report.status, SolveStatus::kRankDeficient) << solver->name();
    EXPECT_EQ(solver->estimate().pose(1), Pose2(2, 0, 0)) << solver->name();
  }
}

}  // namespace
}  // namespace corridor::backend
