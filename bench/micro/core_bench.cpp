// Kernels of the vocabulary: operations on poses, random numbers.
// Time per operation; each argument comes from memory, so that no compiler folds it away.
#include <benchmark/benchmark.h>

#include <vector>

#include "slam/core/pose2.hpp"
#include "slam/core/rng.hpp"

namespace corridor {
namespace {

constexpr std::size_t kNumPoses = 1024;  // a power of two; 24 KiB, within the first cache

std::vector<Pose2> random_poses() {
  Rng rng(1);
  std::vector<Pose2> poses;
  for (std::size_t index = 0; index < kNumPoses; ++index) {
    poses.emplace_back(rng.normal(), rng.normal(), rng.uniform(-3.0, 3.0));
  }
  return poses;
}

void compose_poses(benchmark::State& state) {
  const std::vector<Pose2> poses = random_poses();
  Pose2 T_map_base;
  std::size_t index = 0;
  for (auto _ : state) {
    T_map_base = T_map_base * poses[index++ % kNumPoses];
    benchmark::DoNotOptimize(T_map_base);
  }
}
BENCHMARK(compose_poses)->Name("pose2/compose");

void relative_pose(benchmark::State& state) {
  const std::vector<Pose2> poses = random_poses();
  std::size_t index = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(poses[index % kNumPoses].between(poses[(index + 1) % kNumPoses]));
    ++index;
  }
}
BENCHMARK(relative_pose)->Name("pose2/between");

void exponential_of_logarithm(benchmark::State& state) {
  const std::vector<Pose2> poses = random_poses();
  std::size_t index = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(Pose2::exp(poses[index++ % kNumPoses].log()));
  }
}
BENCHMARK(exponential_of_logarithm)->Name("pose2/exp_log");

void uniform_number(benchmark::State& state) {
  Rng rng(1);
  for (auto _ : state) benchmark::DoNotOptimize(rng.uniform());
}
BENCHMARK(uniform_number)->Name("rng/uniform");

void normal_number(benchmark::State& state) {
  Rng rng(1);
  for (auto _ : state) benchmark::DoNotOptimize(rng.normal());
}
BENCHMARK(normal_number)->Name("rng/normal");

}  // namespace
}  // namespace corridor
