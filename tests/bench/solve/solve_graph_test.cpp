#include "bench/solve/solve_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "slam/backend/fixed_lag/fixed_lag.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/backend/isam2/isam2.hpp"
#include "slam/core/rng.hpp"

namespace corridor::solve {
namespace {

using formats::PoseGraph;

constexpr double kSameOptimum = 1e-6;

PoseGraph::Edge noisy_edge(std::uint32_t i, std::uint32_t j, const PoseGraph& graph, Rng& rng) {
  const Pose2 exact = graph.vertices[i].T_map_base.between(graph.vertices[j].T_map_base);
  const Pose2 noise = Pose2::exp({rng.normal(0, 0.02), rng.normal(0, 0.02), rng.normal(0, 0.01)});
  return {i, j, exact * noise, Eigen::Vector3d(2500, 2500, 10000).asDiagonal()};
}

// Three rounds of a square of 20 poses, each joined to the one a round before.
PoseGraph rounds() {
  constexpr std::uint32_t kRound = 20;
  Rng rng(7);
  PoseGraph graph;
  Pose2 T_map_base;
  for (std::uint32_t i = 0; i < 3 * kRound; ++i) {
    graph.vertices.push_back({i, T_map_base});
    T_map_base = T_map_base * Pose2(1, 0, (i + 1) % 5 == 0 ? 1.5707963267948966 : 0);
  }
  for (std::uint32_t i = 1; i < graph.vertices.size(); ++i) {
    graph.edges.push_back(noisy_edge(i - 1, i, graph, rng));
    if (i >= kRound) graph.edges.push_back(noisy_edge(i - kRound, i, graph, rng));
  }
  return graph;
}

std::unique_ptr<backend::BackEnd> gauss_newton() {
  backend::LeastSquaresParams params;
  params.min_relative_decrease = 1e-12;
  return backend::make_least_squares(params);
}

SolveRun solved(const PoseGraph& graph, backend::BackEnd& back_end, const SolveOptions& options) {
  const auto run = solve_graph(graph, back_end, options);
  EXPECT_TRUE(run.has_value());
  return run.value_or(SolveRun());
}

double largest_difference(const graph::Values& a, const graph::Values& b) {
  double largest = 0;
  for (const graph::Key key : a.keys()) {
    largest = std::max(largest, a.pose(key.index).minus(b.pose(key.index)).norm());
  }
  return largest;
}

TEST(SolveGraph, EveryInitialisationEndsAtTheSameOptimum) {
  const PoseGraph graph = rounds();
  const auto from_file = gauss_newton();
  const SolveRun file = solved(graph, *from_file, {});
  for (const auto init : {Initialization::kOdometry, Initialization::kChordal}) {
    const auto back_end = gauss_newton();
    const SolveRun run = solved(graph, *back_end, {.init = init});
    EXPECT_EQ(run.status, backend::SolveStatus::kConverged);
    EXPECT_NE(*run.chi2_initial, *file.chi2_initial);
    EXPECT_LT(largest_difference(back_end->estimate(), from_file->estimate()), kSameOptimum);
  }
}

TEST(SolveGraph, PoseByPoseEndsNearTheBatchOptimumInGroupsToo) {
  const PoseGraph graph = rounds();
  const auto batch = gauss_newton();
  const SolveRun best = solved(graph, *batch, {});
  for (const int every : {1, 7}) {
    const auto back_end = backend::make_isam2({});
    const SolveRun run =
        solved(graph, *back_end, {.mode = Mode::kIncremental, .poses_per_update = every});
    EXPECT_EQ(run.updates_s.size(), every == 1 ? 60U : 9U);
    EXPECT_EQ(run.online.size(), graph.vertices.size());
    EXPECT_NEAR(*run.chi2, *best.chi2, 1e-2 * *best.chi2);
    EXPECT_FALSE(run.chi2_initial.has_value());
  }
}

// An observer of what is asked of a back-end.
class Counting final : public backend::BackEnd {
 public:
  [[nodiscard]] std::string_view name() const override { return inner_->name(); }
  backend::BackEndReport update(std::vector<graph::NewFactor> factors, const graph::Values& values,
                                std::span<const graph::FactorId> removed) override {
    solved_at.push_back(num_read);
    return inner_->update(std::move(factors), values, removed);
  }
  std::vector<graph::FactorId> add(std::vector<graph::NewFactor> factors,
                                   const graph::Values& values) override {
    return inner_->add(std::move(factors), values);
  }
  backend::BackEndReport solve() override { return inner_->solve(); }
  backend::BackEndReport update_until_converged(const backend::ConvergenceBudget& budget) override {
    return inner_->update_until_converged(budget);
  }
  void set_values(const graph::Values& values) override { inner_->set_values(values); }
  [[nodiscard]] const graph::Values& estimate() const override { return inner_->estimate(); }
  Pose2 pose(std::uint32_t index) override {
    num_read = std::max(num_read, index + 1);
    return inner_->pose(index);
  }
  [[nodiscard]] const graph::FactorGraph& graph() const override { return inner_->graph(); }
  Result<Eigen::MatrixXd> marginal_covariance(graph::Key key) override {
    return inner_->marginal_covariance(key);
  }

  std::uint32_t num_read = 0;            // poses read so far, newest included
  std::vector<std::uint32_t> solved_at;  // num_read at every update()

 private:
  std::unique_ptr<backend::BackEnd> inner_ = gauss_newton();
};

TEST(SolveGraph, EveryPoseIsReadAtItsStepAndSolvedAtEveryKth) {
  const PoseGraph graph = rounds();  // 60 poses
  Counting back_end;
  const SolveRun run =
      solved(graph, back_end, {.mode = Mode::kIncremental, .poses_per_update = 25});
  EXPECT_EQ(back_end.solved_at, (std::vector<std::uint32_t>{24, 49, 59}));
  EXPECT_EQ(back_end.num_read, 60u);
  EXPECT_EQ(run.num_iterations, 3);
}

TEST(SolveGraph, ConvergingAfterTheLastPoseEndsAtTheBatchOptimum) {
  const PoseGraph graph = rounds();
  const auto batch = gauss_newton();
  const SolveRun best = solved(graph, *batch, {});
  const auto back_end = backend::make_isam2({});
  const SolveRun run = solved(graph, *back_end, {.mode = Mode::kIncremental, .do_converge = true});
  EXPECT_EQ(run.status, backend::SolveStatus::kConverged);
  EXPECT_NEAR(*run.chi2, *best.chi2, 1e-6 * *best.chi2);
  EXPECT_GT(*run.converge_rounds, 0);
  EXPECT_LT(*run.converge_s, run.total_s);
}

TEST(SolveGraph, EdgesToPosesThatAWindowForgotAreCountedAndStillScored) {
  const PoseGraph graph = rounds();
  for (const auto& [lag, num_dropped] : {std::pair{60, 0}, std::pair{10, 40}}) {
    const auto back_end = backend::make_fixed_lag({.lag = lag, .isam2 = {}});
    const SolveRun run = solved(graph, *back_end, {.mode = Mode::kIncremental});
    EXPECT_EQ(run.num_dropped, num_dropped);
    EXPECT_EQ(back_end->estimate().size(), graph.vertices.size());
    EXPECT_NEAR(*run.chi2, formats::factor_graph_of(graph).factors.chi2(back_end->estimate()),
                1e-9 * *run.chi2);
  }
}

TEST(SolveGraph, FixedPosesStayWhereTheFileHasThem) {
  PoseGraph graph = rounds();
  graph.fixed = {5, 40};
  graph.vertices[40].T_map_base = graph.vertices[40].T_map_base * Pose2(0.3, -0.2, 0.1);
  for (const Mode mode : {Mode::kBatch, Mode::kIncremental}) {
    const auto back_end = gauss_newton();
    (void)solved(graph, *back_end, {.mode = mode});
    for (const std::uint32_t pose : graph.fixed) {
      EXPECT_LT(back_end->estimate().pose(pose).minus(graph.vertices[pose].T_map_base).norm(),
                1e-4);
    }
  }
}

TEST(SolveGraph, AKernelKeepsAFalseClosureFromBendingTheGraph) {
  PoseGraph graph = rounds();
  const auto without = gauss_newton();
  (void)solved(graph, *without, {});
  graph.edges.push_back({3, 33, Pose2(0, 0, 0), Eigen::Vector3d(2500, 2500, 10000).asDiagonal()});
  const auto bent = gauss_newton();
  (void)solved(graph, *bent, {});
  const auto robust = gauss_newton();
  const SolveRun run = solved(graph, *robust, {.kernel = {graph::KernelKind::kGemanMcClure, 3.0}});
  EXPECT_LT(10 * largest_difference(robust->estimate(), without->estimate()),
            largest_difference(bent->estimate(), without->estimate()));
  EXPECT_LT(*run.cost, *run.chi2);
}

TEST(SolveGraph, APoseThatCannotBeReachedIsNamed) {
  PoseGraph graph = rounds();
  graph.vertices.push_back({77, {}});
  for (const Mode mode : {Mode::kBatch, Mode::kIncremental}) {
    const auto back_end = gauss_newton();
    const auto run = solve_graph(graph, *back_end, {.mode = mode});
    ASSERT_FALSE(run.has_value());
    EXPECT_EQ(run.error().what, "pose 77 cannot be reached from pose 0 (1 of 61 poses cannot)");
  }
}

TEST(SolveGraph, NumbersBeyondAllBoundsEndInAStatusOrAnErrorOnEveryWay) {
  PoseGraph graph;
  for (std::uint32_t i = 0; i < 4; ++i) graph.vertices.push_back({i, {}});
  for (std::uint32_t i = 1; i < 4; ++i) {
    graph.edges.push_back({i - 1, i, Pose2(1e308, 0, 0), Eigen::Matrix3d::Identity()});
  }
  const auto batch = gauss_newton();
  EXPECT_EQ(solved(graph, *batch, {}).status, backend::SolveStatus::kNotFinite);
  for (const auto init : {Initialization::kOdometry, Initialization::kChordal}) {
    const auto back_end = gauss_newton();
    EXPECT_FALSE(solve_graph(graph, *back_end, {.init = init}).has_value());
  }
  for (const int every : {1, 4}) {
    const auto back_end = gauss_newton();
    const SolveRun run =
        solved(graph, *back_end, {.mode = Mode::kIncremental, .poses_per_update = every});
    EXPECT_NE(run.status, backend::SolveStatus::kConverged);
    EXPECT_NE(run.status_message, "");
    EXPECT_FALSE(run.chi2.has_value());
  }
}

TEST(SolveGraph, SingularInformationIsRefusedOnlyWhereItLeavesAPoseFree) {
  PoseGraph graph = rounds();
  // The last pose has another edge: this one may say nothing along x.
  graph.edges.back().information(0, 0) = 0;
  const auto determined = gauss_newton();
  EXPECT_EQ(solved(graph, *determined, {}).status, backend::SolveStatus::kConverged);
  graph.vertices.push_back({60, {}});
  graph.edges.push_back({59, 60, {}, Eigen::Vector3d(1, 0, 1).asDiagonal()});
  const auto free = gauss_newton();
  const auto run = solve_graph(graph, *free, {});
  ASSERT_FALSE(run.has_value());
  EXPECT_EQ(run.error().what,
            "pose 60 is undetermined: 2 edges with singular information leave directions free");
}

}  // namespace
}  // namespace corridor::solve
