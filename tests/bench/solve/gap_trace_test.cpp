#include "bench/solve/gap_trace.hpp"

#include <gtest/gtest.h>

#include "bench/solve/optimum.hpp"
#include "datasets/simulation/manhattan_walk.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/backend/isam2/isam2.hpp"

namespace corridor::solve {
namespace {

constexpr double kSameOptimum = 1e-9;
// Reading one pose and reading all sum in another order.
constexpr double kSamePose = 1e-9;

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
              .after_update = [&](const backend::BackEnd& solver, const Update& update) {
                ++num_told;
                EXPECT_EQ(solver.estimate().size(), update.num_poses);
                const Pose2 T_map_newest = solver.estimate().pose(update.newest);
                EXPECT_LT(T_map_newest.minus(update.T_map_newest).norm(), kSamePose);
              }});
  ASSERT_EQ(run.updates.size(), run.updates_s.size());
  EXPECT_EQ(num_told, run.updates.size());
  EXPECT_EQ(run.updates.back().num_poses, 200U);
  std::int64_t num_eliminated = 0, num_relinearized = 0;
  for (const Update& update : run.updates) {
    num_eliminated += update.num_eliminated;
    num_relinearized += update.num_relinearized;
  }
  EXPECT_EQ(num_eliminated, run.num_eliminated);
  EXPECT_EQ(num_relinearized, run.num_relinearized);
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
  EXPECT_EQ(last.chi2, *run.chi2) << "the replay is the run";
  EXPECT_NEAR(last.chi2_optimum, optimum_of(graph)->chi2, 1e-6 * last.chi2_optimum);
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
