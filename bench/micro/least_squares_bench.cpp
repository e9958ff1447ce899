// Batch least squares on pose graphs of growing size: laps around a square with a loop closure
// every 20 poses, started from noisy odometry. Time of one solve() to convergence.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "slam/backend/ceres/ceres_back_end.hpp"
#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/core/rng.hpp"
#include "slam/graph/factors/pose_factors.hpp"

namespace corridor {
namespace {

constexpr double kPositionSigma_m = 0.02;
constexpr double kAngleSigma_rad = 0.01;

struct Problem {
  std::vector<graph::NewFactor> factors;
  graph::Values values;
};

Pose2 with_noise(const Pose2& T_i_j, Rng& rng) {
  return T_i_j.plus({rng.normal(0, kPositionSigma_m), rng.normal(0, kPositionSigma_m),
                     rng.normal(0, kAngleSigma_rad)});
}

// Laps around a square of 5 poses a side: pose k + 20 comes back to pose k.
Problem make_problem(std::uint32_t num_poses) {
  Rng rng(1);
  const Eigen::Matrix3d sqrt_information =
      Eigen::Vector3d(1 / kPositionSigma_m, 1 / kPositionSigma_m, 1 / kAngleSigma_rad).asDiagonal();
  Problem problem;
  std::vector<Pose2> true_poses{Pose2()};
  Pose2 T_map_base;
  problem.values.set_pose(0, T_map_base);
  problem.factors.push_back(graph::PosePrior(graph::pose_key(0), T_map_base, sqrt_information));
  for (std::uint32_t index = 1; index < num_poses; ++index) {
    const Pose2 T_i_j(1, 0, index % 5 == 0 ? 1.57 : 0.0);
    true_poses.push_back(true_poses.back() * T_i_j);
    const Pose2 measured = with_noise(T_i_j, rng);
    T_map_base = T_map_base * measured;
    problem.values.set_pose(index, T_map_base);
    problem.factors.push_back(graph::RelativePose(
        graph::pose_key(index - 1), graph::pose_key(index), measured, sqrt_information));
    if (index % 20 != 0) continue;
    const Pose2 T_old_new = true_poses[index - 20].between(true_poses[index]);
    problem.factors.push_back(graph::RelativePose(graph::pose_key(index - 20),
                                                  graph::pose_key(index),
                                                  with_noise(T_old_new, rng), sqrt_information));
  }
  return problem;
}

template <class MakeBackEnd>
void solve(benchmark::State& state, const MakeBackEnd& make) {
  int num_iterations = 0;
  for (auto _ : state) {
    state.PauseTiming();
    Problem problem = make_problem(static_cast<std::uint32_t>(state.range(0)));
    const auto solver = make();
    solver->add(std::move(problem.factors), problem.values);
    state.ResumeTiming();
    const backend::BackEndReport report = solver->solve();
    if (report.status != backend::SolveStatus::kConverged) state.SkipWithError("not converged");
    num_iterations = report.num_iterations;
  }
  state.counters["solver_iterations"] = num_iterations;
}

void gauss_newton(benchmark::State& state) {
  solve(state, [] { return backend::make_least_squares({}); });
}
void levenberg_marquardt(benchmark::State& state) {
  solve(state, [] { return backend::make_least_squares({.use_damping = true}); });
}
void ceres(benchmark::State& state) {
  solve(state, [] { return backend::make_ceres({}); });
}
void ceres_tuned(benchmark::State& state) {
  solve(state, [] { return backend::make_ceres(backend::tuned_ceres_params()); });
}
void ceres_tuned_on_cxsparse(benchmark::State& state) {
  backend::CeresParams params = backend::tuned_ceres_params();
  params.sparse_library = "CX_SPARSE";
  solve(state, [&] { return backend::make_ceres(params); });
}
BENCHMARK(gauss_newton)
    ->Name("backend/gauss_newton")
    ->Arg(100)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(levenberg_marquardt)
    ->Name("backend/levenberg")
    ->Arg(100)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(ceres)->Name("backend/ceres")->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK(ceres_tuned)
    ->Name("backend/ceres_tuned")
    ->Arg(100)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(ceres_tuned_on_cxsparse)
    ->Name("backend/ceres_tuned_on_cxsparse")
    ->Arg(100)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace corridor
