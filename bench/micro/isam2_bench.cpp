// iSAM2 on a Manhattan-like walk: every update of the way with the newest pose read after it, a
// full relinearisation, reading poses, and what linearising a factor costs.
#include <benchmark/benchmark.h>

#include <memory>
#include <utility>
#include <vector>

#include "datasets/simulation/manhattan_walk.hpp"
#include "slam/backend/isam2/isam2.hpp"
#include "slam/graph/factor_graph.hpp"

namespace corridor::backend {
namespace {

constexpr std::uint32_t kNumPoses = 3500;
// Short enough for count.sh, where a walk takes some hundred times as long.
constexpr std::uint32_t kNumPosesCounted = 500;

// The factors that arrive with every pose; those of pose 0 hold the gauge.
std::vector<std::vector<graph::NewFactor>> factors_of_a_walk(std::uint32_t num_poses) {
  const simulation::WalkGraph walk = simulation::walk_graph({num_poses, 1});
  const formats::GraphProblem problem = formats::factor_graph_of(walk.graph);
  std::vector<std::vector<graph::NewFactor>> factors(num_poses);
  factors[0].push_back(
      graph::PosePrior(graph::pose_key(0), walk.true_poses[0], 1e3 * Eigen::Matrix3d::Identity()));
  problem.factors.for_each(
      [&]<class F>(graph::FactorId id, const F& factor, const graph::RobustKernel&) {
        factors[walk.graph.edges[id].j].push_back(factor);
      });
  return factors;
}

Pose2 along_odometry(const graph::NewFactor& odometry, const Pose2& T_map_base) {
  return T_map_base * std::get<graph::RelativePose>(odometry.factor).measured_T_i_j();
}

struct Totals {
  std::int64_t num_eliminated = 0, num_relinearized = 0;
};

std::unique_ptr<BackEnd> walk_along(const std::vector<std::vector<graph::NewFactor>>& factors,
                                    Totals& totals) {
  std::unique_ptr<BackEnd> solver = make_isam2({});
  Pose2 newest;
  for (std::uint32_t pose = 0; pose < factors.size(); ++pose) {
    if (pose > 0) newest = along_odometry(factors[pose].front(), newest);
    graph::Values values;
    values.set_pose(pose, newest);
    const BackEndReport report = solver->update(factors[pose], values, {});
    totals.num_eliminated += report.num_eliminated;
    totals.num_relinearized += report.num_relinearized;
    newest = solver->pose(pose);
  }
  return solver;
}

std::unique_ptr<BackEnd> after_a_walk(std::uint32_t num_poses) {
  Totals totals;
  return walk_along(factors_of_a_walk(num_poses), totals);
}

void update_all(benchmark::State& state) {
  const auto factors = factors_of_a_walk(static_cast<std::uint32_t>(state.range(0)));
  const auto num_updates = static_cast<double>(factors.size());
  Totals totals;
  for (auto _ : state) {
    totals = {};
    benchmark::DoNotOptimize(walk_along(factors, totals));
  }
  state.counters["updates"] = num_updates;
  state.counters["eliminated_per_update"] =
      static_cast<double>(totals.num_eliminated) / num_updates;
  state.counters["relinearized_per_update"] =
      static_cast<double>(totals.num_relinearized) / num_updates;
}
BENCHMARK(update_all)
    ->Name("backend/isam2/update_all")
    ->Arg(kNumPosesCounted)
    ->Arg(kNumPoses)
    ->Unit(benchmark::kMillisecond);

void relinearize_all(benchmark::State& state) {
  const std::unique_ptr<BackEnd> solver = after_a_walk(static_cast<std::uint32_t>(state.range(0)));
  int num_iterations = 0;
  for (auto _ : state) num_iterations += solver->solve().num_iterations;
  state.counters["iterations"] =
      benchmark::Counter(num_iterations, benchmark::Counter::kAvgIterations);
}
BENCHMARK(relinearize_all)
    ->Name("backend/isam2/solve")
    ->Arg(kNumPosesCounted)
    ->Arg(kNumPoses)
    ->Unit(benchmark::kMillisecond);

// The newest pose costs the way from the root, the whole estimate a pass over the tree.
void read_pose(benchmark::State& state) {
  const std::unique_ptr<BackEnd> solver = after_a_walk(kNumPoses);
  const auto pose = static_cast<std::uint32_t>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(solver->pose(pose));
}
BENCHMARK(read_pose)->Name("backend/isam2/read_pose")->Arg(kNumPoses - 1)->Arg(0);

void linearize(benchmark::State& state) {
  const std::unique_ptr<BackEnd> solver = after_a_walk(static_cast<std::uint32_t>(state.range(0)));
  const graph::FactorGraph& graph = solver->graph();
  const graph::Values& values = solver->estimate();
  for (auto _ : state) {
    graph.for_each([&]<class F>(graph::FactorId, const F& factor, const graph::RobustKernel&) {
      graph::Residual<F> r;
      graph::Jacobian<F> J;
      factor.linearize(values, r, J);
      benchmark::DoNotOptimize(J);
    });
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(graph.num_factors()));
}
BENCHMARK(linearize)
    ->Name("graph/linearize")
    ->Arg(kNumPosesCounted)
    ->Arg(kNumPoses)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace corridor::backend
