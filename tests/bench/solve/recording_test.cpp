// Graphs as a system's back-end was told them: what is kept, and that it can be told again.
#include "bench/solve/recording.hpp"

#include <gtest/gtest.h>

#include "bench/solve/gap_trace.hpp"
#include "bench/solve/optimum.hpp"
#include "bench/solve/solve_graph.hpp"
#include "datasets/simulation/manhattan_walk.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/backend/isam2/isam2.hpp"

namespace corridor::solve {
namespace {

using graph::FactorId;

constexpr std::uint32_t kNumPoses = 80;
// A closure that is removed again, and one that stays with a kernel that gives way to it.
constexpr double kFalseX_m = 30;

graph::RelativePose far_edge(std::uint32_t i, std::uint32_t j) {
  return {graph::pose_key(i), graph::pose_key(j), Pose2(kFalseX_m, 0, 0),
          Eigen::Matrix3d::Identity()};
}

// What a system might do with its back-end: a pose after the other, some of them without a
// solution, now and then values of its own, a false closure that it takes back, and one that stays.
void drive(backend::BackEnd& back_end) {
  const formats::PoseGraph walk = simulation::walk_graph({kNumPoses, 3}).graph;
  const formats::GraphProblem problem = formats::factor_graph_of(walk);
  std::vector<std::vector<graph::NewFactor>> arriving(kNumPoses);
  for (FactorId id = 0; id < problem.factors.end_id(); ++id) {
    const auto keys = problem.factors.keys(id);
    problem.factors.visit(id, [&](const auto& factor, const graph::RobustKernel&) {
      arriving[std::max(keys[0].index, keys[1].index)].emplace_back(factor);
    });
  }
  arriving[0].emplace_back(
      graph::PosePrior(graph::pose_key(0), Pose2(), Eigen::Matrix3d::Identity()));
  std::vector<FactorId> removed;
  for (std::uint32_t k = 0; k < kNumPoses; ++k) {
    graph::Values values;
    values.set_pose(k, problem.values.pose(k));
    if (k == 30) arriving[k].emplace_back(far_edge(5, 30));
    if (k == 50) {
      arriving[k].push_back({far_edge(2, 50), {graph::KernelKind::kCauchy, 1}});
    }
    if (k % 4 == 3) {
      back_end.add(std::move(arriving[k]), values);
      continue;
    }
    const auto report = back_end.update(std::move(arriving[k]), values, removed);
    (void)back_end.pose(k);
    removed.clear();
    if (k == 30) removed.push_back(report.new_factor_ids.back());
  }
  graph::Values moved;
  moved.set_pose(40, back_end.pose(40) * Pose2(0.1, 0, 0));
  back_end.set_values(moved);
  back_end.solve();
  (void)back_end.pose(kNumPoses - 1);
  back_end.update_until_converged({});
  (void)back_end.pose(kNumPoses - 1);
}

Recording recording_of(std::unique_ptr<backend::BackEnd> back_end) {
  Recording recording;
  const auto recorder = make_recording(std::move(back_end), recording);
  drive(*recorder);
  recording.final_estimate = recorder->estimate();
  return recording;
}

void expect_same_bits(const graph::Values& a, const graph::Values& b) {
  ASSERT_EQ(a.keys(), b.keys());
  for (const graph::Key key : a.keys()) {
    EXPECT_EQ(a.pose(key.index).x_m(), b.pose(key.index).x_m()) << key.index;
    EXPECT_EQ(a.pose(key.index).y_m(), b.pose(key.index).y_m()) << key.index;
    EXPECT_EQ(a.pose(key.index).theta_rad(), b.pose(key.index).theta_rad()) << key.index;
  }
}

TEST(Recording, ReplayedIntoTheSameKindOfBackEndGivesTheSameEstimateToTheBit) {
  const auto check = [](const auto& make) {
    const Recording recording = recording_of(make());
    const auto back_end = make();
    const Result<SolveRun> run = solve_graph(recording, *back_end, {.mode = Mode::kIncremental});
    ASSERT_TRUE(run.has_value());
    expect_same_bits(back_end->estimate(), recording.final_estimate);
    EXPECT_EQ(*run->chi2, recording.factors().cost(recording.final_estimate));
  };
  check([] { return backend::make_least_squares({}); });
  check([] { return backend::make_isam2({}); });
}

TEST(Recording, ForwardsEveryCallUnchanged) {
  const auto alone = backend::make_isam2({});
  drive(*alone);
  expect_same_bits(recording_of(backend::make_isam2({})).final_estimate, alone->estimate());
}

TEST(Recording, KeepsNoFactorThatWasRemovedAndEveryOtherWithItsKernel) {
  const auto alone = backend::make_least_squares({});
  drive(*alone);
  const graph::FactorGraph factors = recording_of(backend::make_least_squares({})).factors();
  EXPECT_EQ(factors.num_factors(), alone->graph().num_factors());
  EXPECT_EQ(factors.cost(alone->estimate()), alone->graph().cost(alone->estimate()));
  EXPECT_LT(factors.cost(alone->estimate()), factors.chi2(alone->estimate())) << "a kernel";
  EXPECT_EQ(kinds_of(factors).at("pose_prior"), 1U);
  EXPECT_EQ(kinds_of(factors).at("relative_pose"), factors.num_factors() - 1);
}

TEST(Recording, HasTheValuesThatVariablesCameWithNotThoseTheyGotLater) {
  const graph::Values values = recording_of(backend::make_isam2({})).initial_values();
  const formats::PoseGraph walk = simulation::walk_graph({kNumPoses, 3}).graph;
  ASSERT_EQ(values.size(), kNumPoses);
  EXPECT_EQ(values.pose(40).x_m(), formats::factor_graph_of(walk).values.pose(40).x_m());
}

TEST(Recording, MapsRemovedFactorsWhereBackEndsNumberThemOtherwise) {
  // Its numbers begin at 2: two factors came and went.
  const auto make_used = [] {
    auto used = backend::make_least_squares({});
    graph::Values values;
    values.set_pose(0, Pose2());
    const graph::PosePrior prior(graph::pose_key(0), Pose2(), Eigen::Matrix3d::Identity());
    const std::vector<FactorId> ids = used->add({prior, prior}, values);
    used->update({prior}, {}, ids);
    return used;
  };
  const Recording recording = recording_of(make_used());
  const auto fresh = backend::make_least_squares({});
  ASSERT_TRUE(solve_graph(recording, *fresh, {.mode = Mode::kIncremental}).has_value());
  EXPECT_EQ(fresh->graph().num_factors(), recording.factors().num_factors());
  EXPECT_NEAR(fresh->graph().cost(fresh->estimate()), recording.factors().cost(fresh->estimate()),
              1e-9);
  const auto used = make_used();
  ASSERT_TRUE(solve_graph(recording, *used, {.mode = Mode::kIncremental}).has_value());
  EXPECT_EQ(used->graph().num_factors(), recording.factors().num_factors() + 1);
  // The prior that it has more is met.
  EXPECT_NEAR(used->graph().cost(used->estimate()), recording.factors().cost(used->estimate()),
              1e-6);
}

TEST(Recording, CountsCallsThatOnlyAddAsPartOfTheUpdateThatSolves) {
  const Recording recording = recording_of(backend::make_isam2({}));
  std::size_t num_solving = 0;
  for (const Step& step : recording.steps) num_solving += step.reading ? 1 : 0;
  EXPECT_EQ(num_solving, kNumPoses * 3 / 4 + 2);
  const auto back_end = backend::make_isam2({});
  const SolveRun run = *solve_graph(recording, *back_end, {.mode = Mode::kIncremental});
  ASSERT_EQ(run.updates.size(), num_solving);
  ASSERT_EQ(run.updates_s.size(), num_solving);
  EXPECT_EQ(run.updates[3].newest, 4U) << "pose 3 was added alone";
  EXPECT_EQ(run.updates[3].num_poses, 5U);
  std::int64_t num_eliminated = 0;
  for (const Update& update : run.updates) num_eliminated += update.num_eliminated;
  EXPECT_EQ(num_eliminated, run.num_eliminated);
}

TEST(Recording, IsSolvedAtOnceToTheOptimumThatItsOwnEstimateLeadsTo) {
  const Recording recording = recording_of(backend::make_isam2({}));
  const Optimum optimum = optimum_of(recording);
  EXPECT_LE(optimum.chi2, recording.factors().cost(recording.final_estimate));
  const auto back_end = backend::make_least_squares({});
  const SolveRun run = *solve_graph(recording, *back_end, {});
  EXPECT_NEAR(*run.chi2, optimum.chi2, 1e-6 * optimum.chi2);
  EXPECT_GT(*run.chi2_initial, *run.chi2);
}

TEST(Recording, IsTracedAlongItsUpdatesAndIsNeverBelowTheOptimum) {
  const Recording recording = recording_of(backend::make_isam2({}));
  const auto back_end = backend::make_isam2({});
  const SolveOptions options{.mode = Mode::kIncremental};
  const std::size_t num_updates = kNumPoses * 3 / 4 + 2;
  const auto checkpoints = trace_gap(recording, *back_end, options, num_updates, 10);
  ASSERT_TRUE(checkpoints.has_value());
  ASSERT_EQ(checkpoints->size(), 10U);
  for (const Checkpoint& checkpoint : *checkpoints) {
    EXPECT_GE(checkpoint.chi2, checkpoint.chi2_optimum);
  }
  const double chi2_optimum = optimum_of(recording).chi2;
  EXPECT_NEAR(checkpoints->back().chi2_optimum, chi2_optimum, 1e-6 * chi2_optimum);
}

TEST(Recording, EndsWhereTheSystemHadItSolvedLast) {
  Recording recording;
  const auto recorder = make_recording(backend::make_isam2({}), recording);
  drive(*recorder);
  const graph::FactorGraph solved = recording.factors();
  graph::Values late;
  late.set_pose(kNumPoses, Pose2());
  recorder->add({far_edge(0, kNumPoses)}, late);
  recording.final_estimate = recorder->estimate();
  EXPECT_EQ(drop_unsolved_end(recording), 1U);
  EXPECT_EQ(recording.factors().num_factors(), solved.num_factors());
  EXPECT_EQ(recording.final_estimate.keys(), recording.initial_values().keys());
  EXPECT_EQ(drop_unsolved_end(recording), 0U);
}

TEST(Recording, OfWhatWasMarginalizedIsReplayedByThoseWhoCanAndRefusedByOthers) {
  Recording recording;
  const auto recorder = make_recording(backend::make_isam2({}), recording);
  drive(*recorder);
  const graph::Key first = graph::pose_key(0);
  ASSERT_TRUE(recorder->marginalize({&first, 1}).has_value());
  recorder->solve();
  recording.final_estimate = recorder->estimate();
  const auto able = backend::make_isam2({});
  const Result<SolveRun> run = solve_graph(recording, *able, {.mode = Mode::kIncremental});
  ASSERT_TRUE(run.has_value());
  expect_same_bits(able->estimate(), recording.final_estimate);
  EXPECT_TRUE(run->chi2.has_value()) << "of the whole graph, at the values that poses left with";
  const auto unable = backend::make_least_squares({});
  EXPECT_FALSE(solve_graph(recording, *unable, {.mode = Mode::kIncremental}).has_value());
  const auto at_once = backend::make_least_squares({});
  EXPECT_TRUE(solve_graph(recording, *at_once, {}).has_value()) << "whole, as it was";
}

}  // namespace
}  // namespace corridor::solve
