#include "bench/solve/gap_trace.hpp"

#include <gtest/gtest.h>

#include "bench/solve/optimum.hpp"
#include "datasets/simulation/manhattan_walk.hpp"
#include "slam/backend/fixed_lag/fixed_lag.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/backend/isam2/isam2.hpp"

namespace corridor::solve {
namespace {

constexpr double kSameOptimum = 1e-9;
// The same numbers summed in another order.
constexpr double kSameSum = 1e-13;

formats::PoseGraph walk() { return simulation::walk_graph({200, 3}).graph; }

SolveRun run_of(const SolveOptions& options) {
  const auto back_end = backend::make_isam2({});
  return *solve_graph(walk(), *back_end, options);
}

TEST(SolveGraph, SaysOfEveryUpdateWhichPosesItHadAndWhatItDid) {
  std::size_t num_told = 0;
  const SolveRun run =
      run_of({.mode = Mode::kIncremental,
              .poses_per_update = 7,
              .after_update = [&](const Moment& moment) {
                ++num_told;
                EXPECT_EQ(moment.back_end.estimate().size(), moment.update.num_poses);
                EXPECT_EQ(moment.told.num_factors(), moment.back_end.graph().num_factors());
                EXPECT_EQ(moment.estimate().size(), moment.update.num_poses);
              }});
  ASSERT_EQ(run.updates.size(), 29U) << "200 poses, seven at a time; the last one always updates";
  ASSERT_EQ(run.updates.size(), run.updates_s.size());
  EXPECT_EQ(num_told, run.updates.size());
  EXPECT_EQ(run.updates.front().num_poses, 7U);
  EXPECT_EQ(run.updates.back().num_poses, 200U);
  std::int64_t num_eliminated = 0, num_relinearized = 0;
  for (const Update& update : run.updates) {
    num_eliminated += update.num_eliminated;
    num_relinearized += update.num_relinearized;
  }
  EXPECT_EQ(num_eliminated, run.num_eliminated);
  EXPECT_EQ(num_relinearized, run.num_relinearized);
}

TEST(SolveGraph, ReadsTheNewestPoseAsTheEstimateHasIt) {
  graph::Values newest;
  const SolveRun run =
      run_of({.mode = Mode::kIncremental, .after_update = [&](const Moment& moment) {
                const std::uint32_t pose = moment.update.newest;
                newest.set_pose(pose, moment.estimate().pose(pose));
              }});
  ASSERT_EQ(run.online.size(), newest.size());
  for (const auto& [id, T_map_base] : run.online) {
    EXPECT_LT(T_map_base.minus(newest.pose(id)).norm(), kSameOptimum) << id;
  }
}

TEST(SolveGraph, ReadsEveryPoseWhenItIsTheNewestThoughFewUpdate) {
  const SolveRun often = run_of({.mode = Mode::kIncremental});
  const SolveRun seldom = run_of({.mode = Mode::kIncremental, .poses_per_update = 7});
  ASSERT_EQ(often.online.size(), 200U);
  ASSERT_EQ(seldom.online.size(), 200U);
  for (std::size_t k = 0; k < often.online.size(); ++k) {
    EXPECT_EQ(often.online[k].id, seldom.online[k].id);
  }
}

TEST(OptimumOf, IsBelowWhatEveryBackEndFindsAndNotByMuch) {
  const formats::PoseGraph graph = walk();
  const Optimum optimum = *optimum_of(graph);
  const auto back_end = backend::make_least_squares({});
  const SolveRun run = *solve_graph(graph, *back_end, {.init = Initialization::kChordal});
  EXPECT_LE(optimum.chi2, *run.chi2 * (1 + kSameOptimum));
  EXPECT_NEAR(optimum.chi2, *run.chi2, 1e-6 * *run.chi2);
}

TEST(OptimumNear, IsNeverWorseThanItsFirstStart) {
  const formats::PoseGraph graph = walk();
  const formats::GraphProblem problem = formats::factor_graph_of(graph);
  const double chi2 = chi2_of(problem.factors, problem.values, Measure::kEdges);
  // Without a prior the graph is free to move: no solver leads anywhere.
  EXPECT_LE(optimum_near(problem.factors, {problem.values}).chi2, chi2);
}

TEST(TraceGap, EndsAtTheOptimumOfTheWholeGraphAndIsNeverBelowIt) {
  const formats::PoseGraph graph = walk();
  const SolveOptions options{.mode = Mode::kIncremental};
  const SolveRun run = run_of(options);
  const auto back_end = backend::make_isam2({});
  const auto checkpoints = trace_gap(graph, *back_end, options, run.updates.size(), 10);
  ASSERT_TRUE(checkpoints.has_value());
  ASSERT_EQ(checkpoints->size(), 10U);
  for (const Checkpoint& checkpoint : *checkpoints) {
    EXPECT_GE(checkpoint.chi2, checkpoint.chi2_optimum);
  }
  EXPECT_EQ(checkpoints->front().update_index, 19U);
  const Checkpoint& last = checkpoints->back();
  EXPECT_EQ(last.update_index, run.updates.size() - 1);
  EXPECT_NEAR(last.chi2, *run.chi2, kSameSum * last.chi2) << "the replay is the run";
  EXPECT_NEAR(last.chi2_optimum, optimum_of(graph)->chi2, 1e-6 * last.chi2_optimum);
}

// A window of its own is always near its own optimum: the graph that it was told is not.
TEST(TraceGap, CountsWhatAWindowForgetsAsMuchAsWhatItHolds) {
  const formats::PoseGraph graph = walk();
  const SolveOptions options{.mode = Mode::kIncremental};
  backend::FixedLagParams params;
  params.lag = 20;
  const auto run = solve_graph(graph, *backend::make_fixed_lag(params), options);
  ASSERT_TRUE(run.has_value());
  ASSERT_GT(run->num_dropped, 0);
  const auto window = backend::make_fixed_lag(params);
  const auto checkpoints = trace_gap(graph, *window, options, run->updates.size(), 10);
  ASSERT_TRUE(checkpoints.has_value());
  const Checkpoint& last = checkpoints->back();
  EXPECT_NEAR(last.chi2, *run->chi2, kSameSum * last.chi2)
      << "of all edges, those that were left out among them";
  EXPECT_NEAR(last.chi2_optimum, optimum_of(graph)->chi2, 1e-6 * last.chi2_optimum);
  EXPECT_GT(last.chi2, 1.1 * last.chi2_optimum);
}

TEST(TraceGap, SeesWhatASolverThatIsCalledOnlyNowAndThenLeavesUndone) {
  const formats::PoseGraph graph = walk();
  // Never moves a pose: every update stops before it begins.
  class Lazy : public backend::BackEnd {
   public:
    [[nodiscard]] std::string_view name() const override { return "lazy"; }
    backend::BackEndReport update(std::vector<graph::NewFactor> factors,
                                  const graph::Values& values,
                                  std::span<const graph::FactorId>) override {
      solver_->add(std::move(factors), values);
      backend::BackEndReport report;
      report.status = backend::SolveStatus::kMaxIterations;
      return report;
    }
    std::vector<graph::FactorId> add(std::vector<graph::NewFactor> factors,
                                     const graph::Values& values) override {
      return solver_->add(std::move(factors), values);
    }
    backend::BackEndReport solve() override { return {}; }
    backend::BackEndReport update_until_converged(const backend::ConvergenceBudget&) override {
      return {};
    }
    void set_values(const graph::Values& values) override { solver_->set_values(values); }
    [[nodiscard]] const graph::Values& estimate() const override { return solver_->estimate(); }
    [[nodiscard]] const graph::FactorGraph& graph() const override { return solver_->graph(); }
    Result<Eigen::MatrixXd> marginal_covariance(graph::Key key) override {
      return solver_->marginal_covariance(key);
    }

   private:
    std::unique_ptr<backend::BackEnd> solver_ = backend::make_least_squares({});
  } lazy;
  const auto checkpoints = trace_gap(graph, lazy, {.mode = Mode::kIncremental}, 200, 5);
  ASSERT_TRUE(checkpoints.has_value());
  EXPECT_GT(checkpoints->back().chi2, 10 * checkpoints->back().chi2_optimum);
  EXPECT_GT(checkpoints->back().newest_gap_m, 0.05);
}

}  // namespace
}  // namespace corridor::solve
