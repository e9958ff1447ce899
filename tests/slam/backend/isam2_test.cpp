#include "slam/backend/isam2/isam2.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <set>

#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "tests/slam/backend/ring_problem.hpp"

namespace corridor::backend {
namespace {

using graph::NewFactor;
using graph::pose_key;
using testing::edge;
using testing::largest_difference;
using testing::prior;
using testing::ring;

constexpr double kSameOptimum = 1e-6;

std::unique_ptr<BackEnd> exact_batch() {
  LeastSquaresParams params;
  params.max_iterations = 100;
  params.min_relative_decrease = 1e-14;
  return make_least_squares(params);
}

Isam2Params exact_solution() {
  Isam2Params params;
  params.wildfire = 0;
  return params;
}

// Feeds both with the same graph, step by step.
void feed(BackEnd& a, BackEnd& b, const testing::PoseGraph& problem) {
  for (std::uint32_t i = 0; i < problem.steps.size(); ++i) {
    graph::Values values;
    values.set_pose(i, problem.initial.pose(i));
    EXPECT_NE(a.update(problem.steps[i], values, {}).status, SolveStatus::kRankDeficient);
    (void)b.add(problem.steps[i], values);
  }
}

RC_GTEST_PROP(Isam2, SolvesToTheBatchOptimum, (std::uint64_t seed)) {
  const auto incremental = make_isam2({});
  const auto batch = exact_batch();
  feed(*incremental, *batch, ring(seed));
  RC_ASSERT(batch->solve().status == SolveStatus::kConverged);
  RC_ASSERT(incremental->solve().status == SolveStatus::kConverged);
  RC_ASSERT(largest_difference(incremental->estimate(), batch->estimate()) < kSameOptimum);
}

// A twentieth of a standard deviation of the sharpest edge (1 / 30 rad) is far inside of it.
RC_GTEST_PROP(Isam2, UpdatesAloneStayWithinAShareOfTheNoiseOfTheBatchOptimum,
              (std::uint64_t seed)) {
  const auto incremental = make_isam2({});
  const auto batch = exact_batch();
  feed(*incremental, *batch, ring(seed));
  batch->solve();
  const double optimum = batch->graph().cost(batch->estimate());
  RC_ASSERT(incremental->graph().cost(incremental->estimate()) < optimum + 0.5);
}

// Velocities and biases tied by linear factors: there is nothing to relinearise.
class LinearChain {
 public:
  explicit LinearChain(std::uint64_t seed) : rng_(seed) {}

  // oldest: the first variable that may still be tied to.
  void grow(std::vector<NewFactor>& factors, graph::Values& values, std::uint32_t oldest = 0) {
    const std::uint32_t i = num_++;
    values.set_bias(i, random());
    factors.push_back(graph::BiasPrior(i, random(), motion::ImuBias::Constant(2)));
    if (i > 0) factors.push_back(tie(i - 1, i));
    if (i > oldest + 2) {
      factors.push_back(tie(static_cast<std::uint32_t>(rng_.uniform(oldest, i - 1)), i));
    }
  }
  Rng& rng() { return rng_; }

 private:
  motion::ImuBias random() { return {rng_.normal(), rng_.normal(), rng_.normal(), rng_.normal()}; }
  graph::BiasWalk tie(std::uint32_t i, std::uint32_t j) { return {i, j, {0.5, 1, 2, 1}}; }
  Rng rng_;
  std::uint32_t num_ = 0;
};

double largest_bias_difference(const graph::Values& a, const graph::Values& b) {
  double largest = 0;
  for (const graph::Key key : a.keys()) {
    largest = std::max(largest, (a.bias(key.index) - b.bias(key.index)).norm());
  }
  return largest;
}

RC_GTEST_PROP(Isam2, EqualsTheBatchSolutionAfterEveryUpdateOfALinearGraph, (std::uint64_t seed)) {
  const auto incremental = make_isam2(exact_solution());
  const auto batch = exact_batch();
  LinearChain chain(seed);
  std::vector<graph::FactorId> ties;
  for (int step = 0; step < 30; ++step) {
    std::vector<NewFactor> factors;
    graph::Values values;
    chain.grow(factors, values);
    std::vector<graph::FactorId> removed;
    if (step % 5 == 4) {
      removed.push_back(ties[static_cast<std::size_t>(chain.rng().uniform(0, 0.999) *
                                                      static_cast<double>(ties.size()))]);
      std::erase(ties, removed.front());
    }
    const BackEndReport report = incremental->update(factors, values, removed);
    batch->update(factors, values, removed);
    for (std::size_t k = 0; k < factors.size(); ++k) {
      if (name_of(factors[k].factor) == "bias_walk") ties.push_back(report.new_factor_ids[k]);
    }
    RC_ASSERT(largest_bias_difference(incremental->estimate(), batch->estimate()) < 1e-9);
    RC_ASSERT(std::abs(report.chi2 - batch->graph().chi2(batch->estimate())) <
              1e-9 * (1 + report.chi2));
  }
}

// Of a linear graph a marginal prior says exactly what the factors said.
RC_GTEST_PROP(Isam2, MarginalisingChangesNoEstimateOfTheOthers, (std::uint64_t seed)) {
  const auto incremental = make_isam2(exact_solution());
  const auto batch = exact_batch();
  LinearChain chain(seed);
  std::uint32_t num_gone = 0;
  for (std::uint32_t step = 0; step < 30; ++step) {
    std::vector<NewFactor> factors;
    graph::Values values;
    chain.grow(factors, values, num_gone);
    incremental->update(factors, values, {});
    batch->update(factors, values, {});
    if (step > 4 && step % 3 == 0) {
      const std::vector<graph::Key> oldest = {graph::bias_key(num_gone),
                                              graph::bias_key(num_gone + 1)};
      RC_ASSERT(incremental->marginalize(oldest).has_value());
      num_gone += 2;
    }
    RC_ASSERT(incremental->estimate().size() == step + 1 - num_gone);
    RC_ASSERT(largest_bias_difference(incremental->estimate(), batch->estimate()) < 1e-8);
    const auto newest = graph::bias_key(step);
    RC_ASSERT(
        (*incremental->marginal_covariance(newest) - *batch->marginal_covariance(newest)).norm() <
        1e-8);
  }
}

// A chain of n poses fills nothing: n blocks on the diagonal, n - 1 below it. Cliques of several
// poses may add zeros, and a tree that forgets cliques would keep growing.
TEST(Isam2, CountsTheFactorOfAChain) {
  const auto solver = make_isam2({});
  BackEndReport report;
  constexpr std::uint32_t kNumPoses = 100;
  for (std::uint32_t i = 0; i < kNumPoses; ++i) {
    graph::Values values;
    values.set_pose(i, Pose2(i, 0, 0));
    const NewFactor factor = i == 0 ? NewFactor(prior(0)) : NewFactor(edge(i - 1, i, {1, 0, 0}));
    report = solver->update({factor}, values, {});
  }
  const std::int64_t exact = kNumPoses * 6 + (kNumPoses - 1) * 9;
  EXPECT_GE(report.num_factor_nonzeros, exact);
  EXPECT_LE(report.num_factor_nonzeros, 2 * exact);
}

TEST(Isam2, AWindowThatMovesAlongDoesNotGrow) {
  const auto solver = make_isam2({});
  constexpr std::uint32_t kLag = 20;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    graph::Values values;
    values.set_pose(i, Pose2(i, 0, 0));
    std::vector<NewFactor> factors;
    if (i == 0) {
      factors.push_back(prior(0));
    } else {
      factors.push_back(edge(i - 1, i, {1, 0, 0}));
      if (i % 7 == 6) factors.push_back(edge(i - 6, i, {6, 0, 0}));
    }
    const BackEndReport report = solver->update(std::move(factors), values, {});
    ASSERT_NE(report.status, SolveStatus::kRankDeficient);
    ASSERT_LE(report.num_variables, kLag + 1);
    ASSERT_LE(report.num_factors, 2 * kLag);
    if (i < kLag) continue;
    const std::vector<graph::Key> oldest = {pose_key(i - kLag)};
    ASSERT_TRUE(solver->marginalize(oldest).has_value());
  }
  EXPECT_NEAR(solver->estimate().pose(999).x_m(), 999, 1e-6);
  EXPECT_FALSE(solver->estimate().contains(pose_key(900)));
}

TEST(Isam2, AVariableThatNothingDeterminesIsNotMarginalised) {
  const auto solver = make_isam2({});
  graph::Values values;
  values.set_pose(0, {});
  values.set_pose(1, {1, 0, 0});
  (void)solver->add({prior(0)}, values);
  const std::vector<graph::Key> loose = {pose_key(1)}, unknown = {pose_key(5)};
  EXPECT_FALSE(solver->marginalize(unknown).has_value());
  EXPECT_TRUE(solver->marginalize(loose).has_value());  // nothing is known, nothing is lost
  EXPECT_EQ(solver->update({}, {}, {}).num_variables, 1);
}

RC_GTEST_PROP(Isam2, CovariancesAreThoseOfTheBatchSolution, (std::uint64_t seed)) {
  const auto incremental = make_isam2({});
  const auto batch = exact_batch();
  feed(*incremental, *batch, ring(seed));
  batch->solve();
  incremental->solve();
  for (const std::uint32_t i : {0u, 7u, 23u}) {
    const auto expected = batch->marginal_covariance(pose_key(i));
    const auto found = incremental->marginal_covariance(pose_key(i));
    RC_ASSERT(expected.has_value() && found.has_value());
    RC_ASSERT((*found - *expected).norm() < 1e-5 * expected->norm());
  }
}

TEST(Isam2, APoseReadAloneIsThatOfTheWholeEstimate) {
  const auto solver = make_isam2({});
  const testing::PoseGraph problem = ring(4);
  for (std::uint32_t i = 0; i < problem.steps.size(); ++i) {
    graph::Values values;
    values.set_pose(i, problem.initial.pose(i));
    solver->update(problem.steps[i], values, {});
    const Pose2 newest = solver->pose(i), oldest = solver->pose(0), middle = solver->pose(i / 2);
    EXPECT_LT(newest.minus(solver->estimate().pose(i)).norm(), 1e-12);
    EXPECT_LT(oldest.minus(solver->estimate().pose(0)).norm(), 1e-12);
    EXPECT_LT(middle.minus(solver->estimate().pose(i / 2)).norm(), 1e-12);
  }
}

RC_GTEST_PROP(Isam2, ReadingAnythingAtAnyTimeChangesNoLaterUpdate, (std::uint64_t seed)) {
  const auto read = make_isam2({}), unread = make_isam2({});
  const auto problem = ring(seed);
  for (std::uint32_t i = 0; i < problem.steps.size(); ++i) {
    graph::Values values;
    values.set_pose(i, problem.initial.pose(i));
    const BackEndReport ours = read->update(problem.steps[i], values, {});
    const BackEndReport theirs = unread->update(problem.steps[i], values, {});
    RC_ASSERT(ours.num_relinearized == theirs.num_relinearized);
    RC_ASSERT(ours.num_eliminated == theirs.num_eliminated);
    RC_ASSERT(ours.chi2 == theirs.chi2);
    (void)read->pose(i);
    (void)read->pose(i / 2);
    if (i % 2 == 0) (void)read->estimate();
    (void)read->marginal_covariance(pose_key(i));
  }
  for (std::uint32_t i = 0; i < problem.steps.size(); ++i) {
    RC_ASSERT(read->estimate().pose(i) == unread->estimate().pose(i));
  }
}

TEST(Isam2, AFalseLoopClosureIsUndoneByItsRemoval) {
  const auto solver = make_isam2({});
  const auto batch = exact_batch();
  feed(*solver, *batch, ring(6));
  batch->solve();
  const BackEndReport report = solver->update({edge(3, 20, Pose2(5, 5, 1))}, {}, {});
  solver->solve();
  EXPECT_GT(largest_difference(solver->estimate(), batch->estimate()), 0.1);
  solver->update({}, {}, report.new_factor_ids);
  EXPECT_EQ(solver->solve().status, SolveStatus::kConverged);
  EXPECT_LT(largest_difference(solver->estimate(), batch->estimate()), kSameOptimum);
}

TEST(Isam2, APoseThatNothingHoldsIsNamedAndAFactorForItHeals) {
  const auto solver = make_isam2({});
  graph::Values values;
  values.set_pose(0, {});
  values.set_pose(1, {1, 0, 0});
  values.set_pose(2, {7, 0, 0});
  const BackEndReport report = solver->update({prior(0), edge(0, 1, {1, 0, 0})}, values, {});
  EXPECT_EQ(report.status, SolveStatus::kRankDeficient);
  ASSERT_TRUE(report.undetermined.has_value());
  EXPECT_EQ(*report.undetermined, pose_key(2));
  EXPECT_EQ(solver->estimate().pose(2), Pose2(7, 0, 0));
  EXPECT_FALSE(solver->marginal_covariance(pose_key(0)).has_value());
  EXPECT_NE(solver->update({edge(1, 2, {1, 0, 0})}, {}, {}).status, SolveStatus::kRankDeficient);
  solver->solve();
  EXPECT_NEAR(solver->estimate().pose(2).x_m(), 2, 1e-6);
}

// What elimination leaves of a pose that nothing holds is rounding, of either sign.
RC_GTEST_PROP(Isam2, AGraphThatNothingHoldsIsRefusedAtEveryPose, (std::uint64_t seed)) {
  testing::PoseGraph problem = ring(seed);
  std::erase_if(problem.steps[0], [](const NewFactor& factor) {
    return std::holds_alternative<graph::PosePrior>(factor.factor);
  });
  const auto solver = make_isam2({});
  for (std::uint32_t i = 0; i < problem.steps.size(); ++i) {
    graph::Values values;
    values.set_pose(i, problem.initial.pose(i));
    const BackEndReport report = solver->update(problem.steps[i], values, {});
    if (i == 0) continue;  // no factor yet, nothing to solve
    RC_ASSERT(report.status == SolveStatus::kRankDeficient);
    RC_ASSERT(report.undetermined.has_value());
  }
}

TEST(Isam2, WithoutAPriorNoPoseIsDeterminedAndAllStayAsTheyWere) {
  const auto solver = make_isam2({});
  graph::Values values;
  values.set_pose(0, {});
  values.set_pose(1, {2, 0, 0});
  EXPECT_EQ(solver->update({edge(0, 1, {1, 0, 0})}, values, {}).status,
            SolveStatus::kRankDeficient);
  EXPECT_EQ(solver->estimate().pose(1), Pose2(2, 0, 0));
}

TEST(Isam2, TheBlankOdometryOfAStraightDriveTouchesNoOldVariable) {
  const auto solver = make_isam2({});
  std::int64_t most_eliminated = 0;
  for (std::uint32_t i = 0; i < 200; ++i) {
    graph::Values values;
    values.set_pose(i, Pose2(i, 0, 0));
    std::vector<NewFactor> factors;
    if (i == 0) {
      factors.push_back(prior(0));
    } else {
      factors.push_back(edge(i - 1, i, {1, 0, 0}));
    }
    most_eliminated =
        std::max(most_eliminated, solver->update(std::move(factors), values, {}).num_eliminated);
  }
  EXPECT_LE(most_eliminated, 2 * Isam2Params{}.num_last);
}

TEST(Isam2, AMeasurementThatIsNoNumberIsAStatusAndItsRemovalHeals) {
  const auto solver = make_isam2({});
  const auto batch = exact_batch();
  feed(*solver, *batch, ring(6));
  batch->solve();
  const graph::Values before = solver->estimate();
  const BackEndReport report = solver->update({edge(3, 20, Pose2(NAN, 5, 1))}, {}, {});
  EXPECT_EQ(report.status, SolveStatus::kNotFinite);
  EXPECT_LT(largest_difference(solver->estimate(), before), 1e-12);
  EXPECT_EQ(solver->solve().status, SolveStatus::kNotFinite);
  EXPECT_LT(largest_difference(solver->estimate(), before), 1e-12);
  solver->update({}, {}, report.new_factor_ids);
  EXPECT_EQ(solver->solve().status, SolveStatus::kConverged);
  EXPECT_LT(largest_difference(solver->estimate(), batch->estimate()), kSameOptimum);
}

TEST(Isam2, AVariableNamedTwiceIsMarginalisedOnce) {
  const auto solver = make_isam2({});
  const auto batch = exact_batch();
  feed(*solver, *batch, ring(6));
  solver->solve();
  ASSERT_TRUE(solver->marginalize(std::vector{pose_key(0), pose_key(1), pose_key(0)}));
  EXPECT_FALSE(solver->estimate().contains(pose_key(0)));
  EXPECT_EQ(solver->solve().status, SolveStatus::kConverged);
}

TEST(Isam2, NothingToSolveIsAStatus) {
  EXPECT_EQ(make_isam2({})->solve().status, SolveStatus::kEmpty);
  EXPECT_EQ(make_isam2({})->update({}, {}, {}).status, SolveStatus::kEmpty);
}

}  // namespace
}  // namespace corridor::backend
