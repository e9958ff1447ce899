// Linear solvers on the normal equations of a Manhattan-like walk. Time of every stage, with flops,
// Gflop/s and nonzeros of the factor.
#include <benchmark/benchmark.h>

#include <memory>
#include <utility>
#include <vector>

#include "datasets/simulation/manhattan_walk.hpp"
#include "slam/core/rng.hpp"
#include "slam/linear/block_cholesky.hpp"
#include "slam/linear/front_layout.hpp"
#include "slam/linear/minimum_degree.hpp"
#include "slam/linear/sparse_cholesky.hpp"

namespace corridor::linear {
namespace {

constexpr int kNumPoses = 3500;

// H = sum J^T J with random J, and a prior on the first pose.
struct NormalEquationsOfAWalk {
  std::vector<std::pair<int, int>> edges;  // the later pose first
  BlockMatrix H;
  Eigen::VectorXd b;

  NormalEquationsOfAWalk() {
    Rng rng(1);
    for (const auto& [i, j] : simulation::walk_manhattan(rng, kNumPoses).edges) {
      edges.emplace_back(static_cast<int>(j), static_cast<int>(i));
    }
    for (int pose = 0; pose < kNumPoses; ++pose) H.add_variable(3);
    for (const auto& [i, j] : edges) H.slot(i, j);
    H.set_zero();
    H.add(H.slot(0, 0), Eigen::Matrix3d::Identity());
    for (const auto& [i, j] : edges) {
      Eigen::Matrix3d J_i, J_j;
      for (int k = 0; k < 9; ++k) J_i(k) = rng.normal();
      for (int k = 0; k < 9; ++k) J_j(k) = rng.normal();
      H.add(H.slot(i, i), J_i.transpose() * J_i);
      H.add(H.slot(j, j), J_j.transpose() * J_j);
      H.add(H.slot(i, j), J_i.transpose() * J_j);
    }
    b = Eigen::VectorXd::Ones(H.num_rows());
  }
};

void clear_matrix(benchmark::State& state) {
  NormalEquationsOfAWalk walk;
  for (auto _ : state) {
    walk.H.set_zero();
    benchmark::ClobberMemory();
  }
  state.counters["edges"] = static_cast<double>(walk.edges.size());
}
BENCHMARK(clear_matrix)->Name("linear/matrix/set_zero")->Unit(benchmark::kMicrosecond);

void add_blocks(benchmark::State& state) {
  NormalEquationsOfAWalk walk;
  std::vector<std::size_t> slots;
  for (const auto& [i, j] : walk.edges) slots.push_back(walk.H.slot(i, j));
  const Eigen::Matrix3d summand = Eigen::Matrix3d::Ones();
  for (auto _ : state) {
    for (const std::size_t slot : slots) walk.H.add(slot, summand);
    benchmark::ClobberMemory();
  }
  state.counters["blocks"] = static_cast<double>(slots.size());
}
BENCHMARK(add_blocks)->Name("linear/matrix/add")->Unit(benchmark::kMicrosecond);

void order_variables(benchmark::State& state) {
  const NormalEquationsOfAWalk walk;
  for (auto _ : state) benchmark::DoNotOptimize(minimum_degree_order(walk.H.pattern()));
}
BENCHMARK(order_variables)->Name("linear/order")->Unit(benchmark::kMicrosecond);

void lay_out(benchmark::State& state) {
  const NormalEquationsOfAWalk walk;
  const std::vector<int> order = minimum_degree_order(walk.H.pattern());
  FrontLayout layout;
  for (auto _ : state) benchmark::DoNotOptimize(layout = lay_out_fronts(walk.H, order));
  state.counters["fronts"] = static_cast<double>(layout.fronts.size());
}
BENCHMARK(lay_out)->Name("linear/block/lay_out")->Unit(benchmark::kMicrosecond);

void factorize(benchmark::State& state, LinearSolver& solver) {
  const NormalEquationsOfAWalk walk;
  bool is_ok = solver.factorize(walk.H) == CholeskyStatus::kOk;
  for (auto _ : state) is_ok &= solver.factorize(walk.H) == CholeskyStatus::kOk;
  if (!is_ok) state.SkipWithError("not positive definite");
  state.counters["nonzeros"] = solver.num_factor_nonzeros();
  state.counters["flops"] = solver.num_flops();
  state.counters["Gflop/s"] =
      benchmark::Counter(1e-9 * solver.num_flops(), benchmark::Counter::kIsIterationInvariantRate);
}

void factorize_simplicial(benchmark::State& state) {
  SparseCholesky solver(CholmodMethod::kSimplicial);
  factorize(state, solver);
}
BENCHMARK(factorize_simplicial)
    ->Name("linear/cholmod/factorize_simplicial")
    ->Unit(benchmark::kMicrosecond);

void factorize_supernodal(benchmark::State& state) {
  SparseCholesky solver(CholmodMethod::kSupernodal);
  factorize(state, solver);
}
BENCHMARK(factorize_supernodal)
    ->Name("linear/cholmod/factorize_supernodal")
    ->Unit(benchmark::kMicrosecond);

void factorize_block(benchmark::State& state) {
  BlockCholesky solver;
  factorize(state, solver);
}
BENCHMARK(factorize_block)->Name("linear/block/factorize")->Unit(benchmark::kMicrosecond);

template <class Solver>
void solve(benchmark::State& state) {
  const NormalEquationsOfAWalk walk;
  Solver solver;
  if (solver.factorize(walk.H) != CholeskyStatus::kOk) state.SkipWithError("no factor");
  Eigen::VectorXd x(walk.b.size());
  for (auto _ : state) {
    solver.solve(walk.b, x);
    benchmark::ClobberMemory();
  }
  state.counters["nonzeros"] = solver.num_factor_nonzeros();
}
BENCHMARK(solve<SparseCholesky>)->Name("linear/cholmod/solve")->Unit(benchmark::kMicrosecond);
BENCHMARK(solve<BlockCholesky>)->Name("linear/block/solve")->Unit(benchmark::kMicrosecond);

// From a matrix of a new structure to the solution: order, analysis, factor, substitution.
template <class Solver>
void solve_once(benchmark::State& state) {
  const NormalEquationsOfAWalk walk;
  Eigen::VectorXd x(walk.b.size());
  for (auto _ : state) {
    Solver solver;
    if (solver.factorize(walk.H) != CholeskyStatus::kOk) state.SkipWithError("no factor");
    solver.solve(walk.b, x);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(solve_once<SparseCholesky>)
    ->Name("linear/cholmod/solve_once")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(solve_once<BlockCholesky>)
    ->Name("linear/block/solve_once")
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace corridor::linear
