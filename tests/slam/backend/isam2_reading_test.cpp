// What can be read of isam2 between updates, and what updates leave alone.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "slam/backend/isam2/isam2.hpp"
#include "tests/slam/backend/random_problems.hpp"
#include "tests/support/allocation_counter.hpp"

namespace corridor::backend {
namespace {

using graph::pose_key;

// Whatever is read of a solver is what `expected` says.
void expect_reads(BackEnd& solver, const graph::Values& expected) {
  for (const graph::Key key : expected.keys()) {
    const Pose2& pose = expected.pose(key.index);
    RC_ASSERT(solver.estimate().pose(key.index).minus(pose).norm() < 1e-12);
    RC_ASSERT(solver.pose(key.index).minus(pose).norm() < 1e-12);
  }
}

RC_GTEST_PROP(Isam2, AnUpdateThatFailsOrACovarianceLeavesEveryPoseWhereItWas,
              (std::uint64_t seed)) {
  const auto problem = testing::random_walk(seed);
  const auto solver = make_isam2({});
  (void)solver->update(problem.factors, problem.initial, {});
  // What moves has been marked, and the next update would relinearise it.
  const graph::Values before = solver->estimate();
  graph::Values loose;
  loose.set_pose(1000, {7, 0, 0});
  RC_ASSERT(solver->update({}, loose, {}).status == SolveStatus::kRankDeficient);
  expect_reads(*solver, before);
  RC_ASSERT(!solver->marginal_covariance(pose_key(3)).has_value());
  expect_reads(*solver, before);
  RC_ASSERT(solver
                ->update({graph::RelativePose(pose_key(0), pose_key(1000), {1, 0, 0},
                                              testing::pose_weight(0.03))},
                         {}, {})
                .status != SolveStatus::kRankDeficient);

  const graph::Values solved = solver->estimate();
  graph::Values set;
  set.set_pose(5, solved.pose(5).plus({0.1, 0.1, 0.1}));
  solver->set_values(set);
  graph::Values expected = solved;
  expected.merge(set);
  RC_ASSERT(solver->marginal_covariance(pose_key(3)).has_value());
  expect_reads(*solver, expected);
}

// Elimination where the cliques are, back-substitution and the measure of steps.
TEST(Isam2, AnUpdateThatOnlyRelinearisesAllocatesNothing) {
  if (!testing::kCountsAllocations) GTEST_SKIP() << "not under AddressSanitizer";
  const auto problem = testing::random_walk(1);
  const auto solver = make_isam2({});
  (void)solver->update(problem.factors, problem.initial, {});
  const graph::Values nothing_new;
  int before = testing::num_allocations;
  for (int round = 0; round < 10; ++round) {
    graph::Values moved;
    moved.set_pose(5, solver->pose(5).plus({0.01, 0.02, 0.03}));
    solver->set_values(moved);
    before = testing::num_allocations;
    const BackEndReport report = solver->update({}, nothing_new, {});
    EXPECT_GT(report.num_eliminated, 0);
  }
  EXPECT_EQ(testing::num_allocations, before);
  // The counter counts.
  graph::Values moved;
  moved.set_pose(5, solver->pose(5));
  EXPECT_GT(testing::num_allocations, before);
}

}  // namespace
}  // namespace corridor::backend
