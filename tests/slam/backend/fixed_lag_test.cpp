#include "slam/backend/fixed_lag/fixed_lag.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/LU>
#include <set>

#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "tests/slam/backend/random_problems.hpp"
#include "tests/slam/backend/ring_problem.hpp"

namespace corridor::backend {
namespace {

using graph::NewFactor;
using graph::pose_key;
using testing::edge;
using testing::largest_difference;
using testing::prior;
using testing::ring;

std::unique_ptr<BackEnd> fixed_lag(int lag) {
  FixedLagParams params;
  params.lag = lag;
  return make_fixed_lag(params);
}

std::unique_ptr<BackEnd> exact_batch() {
  LeastSquaresParams params;
  params.max_iterations = 100;
  params.min_relative_decrease = 1e-14;
  return make_least_squares(params);
}

graph::Values pose_at(std::uint32_t i, const Pose2& T_map_base) {
  graph::Values values;
  values.set_pose(i, T_map_base);
  return values;
}

RC_GTEST_PROP(FixedLag, EqualsTheBatchSolutionWhereTheLagCoversAllPoses, (std::uint64_t seed)) {
  const testing::PoseGraph problem = ring(seed);
  const auto lagging = fixed_lag(static_cast<int>(problem.steps.size()));
  const auto batch = exact_batch();
  for (std::uint32_t i = 0; i < problem.steps.size(); ++i) {
    const graph::Values values = pose_at(i, problem.initial.pose(i));
    RC_ASSERT(lagging->update(problem.steps[i], values, {}).num_dropped_factors == 0);
    (void)batch->add(problem.steps[i], values);
  }
  RC_ASSERT(batch->solve().status == SolveStatus::kConverged);
  RC_ASSERT(lagging->update_until_converged({}).status == SolveStatus::kConverged);
  RC_ASSERT(largest_difference(lagging->estimate(), batch->estimate()) < 1e-6);
}

// Poses in a row, each tied to the two before: linear but for the headings, whose truth they start
// at, so that what is marginalised was linearised at the optimum.
void feed_exact_chain(BackEnd& solver, std::uint32_t i) {
  const Pose2 step(1, 0.2, 0.3);
  Pose2 T_map_base;
  for (std::uint32_t k = 0; k < i; ++k) T_map_base = T_map_base * step;
  std::vector<NewFactor> factors;
  if (i == 0) factors.push_back(prior(0));
  if (i > 0) factors.push_back(edge(i - 1, i, step));
  if (i > 1) factors.push_back(edge(i - 2, i, step * step));
  solver.update(std::move(factors), pose_at(i, T_map_base), {});
}

// H of all poses, dense, in ascending order.
Eigen::MatrixXd dense_information(const BackEnd& solver, std::uint32_t first, std::uint32_t num) {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3 * num, 3 * num);
  solver.graph().for_each([&]<class F>(graph::FactorId, const F& factor, const auto&) {
    graph::Residual<F> r;
    graph::Jacobian<F> J;
    factor.linearize(solver.estimate(), r, J);
    Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(J.rows(), 3 * num);
    for (std::size_t k = 0; k < factor.keys().size(); ++k) {
      wide.middleCols<3>(3 * (factor.keys()[k].index - first)) =
          J.middleCols(3 * static_cast<Eigen::Index>(k), 3);
    }
    H += wide.transpose() * wide;
  });
  return H;
}

TEST(FixedLag, TheWindowKnowsWhatTheDenseSchurComplementSays) {
  constexpr std::uint32_t kNum = 12, kLag = 4, kGone = kNum - kLag;
  const auto lagging = fixed_lag(kLag);
  const auto batch = exact_batch();
  for (std::uint32_t i = 0; i < kNum; ++i) {
    feed_exact_chain(*lagging, i);
    feed_exact_chain(*batch, i);
  }
  const Eigen::MatrixXd all = dense_information(*batch, 0, kNum);
  constexpr int kRows = 3 * kGone, kKept = 3 * kLag;
  const Eigen::MatrixXd schur =
      all.bottomRightCorner(kKept, kKept) - all.bottomLeftCorner(kKept, kRows) *
                                                all.topLeftCorner(kRows, kRows).inverse() *
                                                all.topRightCorner(kRows, kKept);
  const Eigen::MatrixXd window = dense_information(*lagging, kGone, kLag);
  EXPECT_LT((window - schur).norm(), 1e-8 * schur.norm());
  const Eigen::MatrixXd covariance = *lagging->marginal_covariance(pose_key(kNum - 1));
  const Eigen::MatrixXd expected = *batch->marginal_covariance(pose_key(kNum - 1));
  EXPECT_LT((covariance - expected).norm(), 1e-8 * expected.norm());
}

// What an update may cost and keep.
struct Extent {
  std::int64_t num_variables = 0, num_factors = 0, num_cliques = 0, memory_bytes = 0;
  std::int64_t num_eliminated = 0;

  void see(const BackEndReport& report) {
    num_variables = std::max(num_variables, report.num_variables);
    num_factors = std::max(num_factors, report.num_factors);
    num_cliques = std::max(num_cliques, report.num_cliques);
    memory_bytes = std::max(memory_bytes, report.front_memory_bytes);
    num_eliminated = std::max(num_eliminated, report.num_eliminated / report.num_iterations);
  }
  bool operator==(const Extent&) const = default;
};

TEST(FixedLag, TheWindowDoesNotGrowInSteadyState) {
  constexpr std::uint32_t kLag = 20, kPeriod = 1000;
  const auto solver = fixed_lag(kLag);
  std::vector<Extent> periods(3);
  for (std::uint32_t i = 0; i < periods.size() * kPeriod; ++i) {
    std::vector<NewFactor> factors;
    factors.emplace_back(i == 0 ? NewFactor(prior(0)) : NewFactor(edge(i - 1, i, {1, 0, 0})));
    if (i % 7 == 6) factors.push_back(edge(i - 6, i, {6, 0, 0}));
    const BackEndReport report =
        solver->update(std::move(factors), pose_at(i, Pose2(i, 0.1, 0)), {});
    ASSERT_NE(report.status, SolveStatus::kRankDeficient);
    ASSERT_EQ(report.num_dropped_factors, 0);
    periods[i / kPeriod].see(report);
  }
  EXPECT_LE(periods[1].num_variables, kLag + 1);
  EXPECT_LE(periods[1].num_eliminated, kLag + 1);
  EXPECT_GT(periods[1].num_cliques, 0);
  EXPECT_EQ(periods[1], periods[2]);
  EXPECT_EQ(solver->estimate().size(), periods.size() * kPeriod);
}

TEST(FixedLag, AFactorOnAPoseThatLeftIsCountedAndItsRemovalHarmless) {
  const auto solver = fixed_lag(3);
  for (std::uint32_t i = 0; i < 10; ++i) feed_exact_chain(*solver, i);
  const std::size_t num_factors = solver->graph().num_factors();
  const auto waiting = solver->add({edge(1, 9, {3, 0, 0})}, {});
  EXPECT_EQ(waiting, std::vector{kNoFactor});
  const BackEndReport report =
      solver->update({edge(0, 8, {3, 0, 0}), edge(8, 9, {1, 0, 0})}, {}, {});
  EXPECT_EQ(report.num_dropped_factors, 2);
  ASSERT_EQ(report.new_factor_ids.size(), 2u);
  EXPECT_EQ(report.new_factor_ids[0], kNoFactor);
  EXPECT_TRUE(solver->graph().contains(report.new_factor_ids[1]));
  EXPECT_EQ(solver->graph().num_factors(), num_factors + 1);
  EXPECT_EQ(solver->update({}, {}, report.new_factor_ids).num_dropped_factors, 0);
  EXPECT_EQ(solver->graph().num_factors(), num_factors);
}

TEST(FixedLag, ARemovalOfWhatThePriorHoldsIsCounted) {
  const auto solver = fixed_lag(3);
  const auto first = solver->update({prior(0)}, pose_at(0, {}), {}).new_factor_ids;
  for (std::uint32_t i = 1; i < 10; ++i) feed_exact_chain(*solver, i);
  EXPECT_EQ(solver->update({}, {}, first).num_late_removals, 1);
  EXPECT_EQ(solver->update({}, {}, {}).num_late_removals, 0);
}

TEST(FixedLag, PosesThatLeftKeepTheirLastValueAndHaveNoCovariance) {
  const auto solver = fixed_lag(3);
  for (std::uint32_t i = 0; i < 10; ++i) feed_exact_chain(*solver, i);
  const Pose2 last = solver->pose(2);
  EXPECT_EQ(solver->estimate().pose(2), last);
  EXPECT_NEAR(last.x_m(),
              Pose2(1, 0.2, 0.3).x_m() + (Pose2(1, 0.2, 0.3) * Pose2(1, 0.2, 0.3)).x_m() - 1, 0.01);
  const auto covariance = solver->marginal_covariance(pose_key(2));
  ASSERT_FALSE(covariance.has_value());
  EXPECT_EQ(covariance.error().what, "pose 2 left the window");
  EXPECT_FALSE(solver->marginalize(std::vector{pose_key(2)}).has_value());
}

// Velocities, biases and a wheel scale that every interval names.
TEST(FixedLag, InertialStatesLeaveWithTheirPosesAndTheWheelScaleStays) {
  const corridor::testing::RandomProblem drive = corridor::testing::random_drive(5);
  const auto solver = fixed_lag(4);
  std::vector<std::vector<NewFactor>> arrivals(15);
  std::vector<graph::Values> values(15);
  for (const NewFactor& factor : drive.factors) {
    std::uint32_t newest = 0;
    for (const graph::Key key : keys_of(factor.factor)) newest = std::max(newest, key.index);
    arrivals[newest].push_back(factor);
  }
  for (const graph::Key key : drive.initial.keys()) values[key.index].copy(key, drive.initial);
  std::int64_t num_dropped = 0;
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    const BackEndReport report = solver->update(arrivals[i], values[i], {});
    ASSERT_NE(report.status, SolveStatus::kRankDeficient) << i;
    ASSERT_LE(report.num_variables, 3 * 6 + 1);
    num_dropped += report.num_dropped_factors;
  }
  EXPECT_GT(num_dropped, 0);
  EXPECT_TRUE(solver->marginal_covariance(graph::wheel_calibration_key(0)).has_value());
  EXPECT_FALSE(solver->marginal_covariance(graph::bias_key(2)).has_value());
  EXPECT_EQ(solver->estimate().size(), drive.initial.size());
}

RC_GTEST_PROP(FixedLag, ReadingChangesNoAnswerByMoreThanAShareOfTheNoise, (std::uint64_t seed)) {
  const auto read = fixed_lag(15), unread = fixed_lag(15);
  const testing::PoseGraph problem = ring(seed);
  for (std::uint32_t i = 0; i < problem.steps.size(); ++i) {
    const graph::Values values = pose_at(i, problem.initial.pose(i));
    (void)read->update(problem.steps[i], values, {});
    (void)read->estimate();
    (void)unread->update(problem.steps[i], values, {});
  }
  // A tenth of the sharpest edge's standard deviation.
  RC_ASSERT(largest_difference(read->estimate(), unread->estimate()) < 0.1 / 30);
}

}  // namespace
}  // namespace corridor::backend
