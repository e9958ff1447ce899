// Kernels around scans, in the paper's corridor with the suite's LiDAR: casting one scan of 360
// beams, drawing scans into an occupancy grid.
#include <benchmark/benchmark.h>

#include <vector>

#include "bench/micro/corridor_scans.hpp"
#include "slam/mapping/occupancy_mapper.hpp"

namespace corridor {
namespace {

void cast_one_scan(benchmark::State& state) {
  const simulation::RayCaster caster(simulation::make_corridor({}));
  const std::vector<Pose2> poses = drive_along(128);
  std::size_t index = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(cast_scan(caster, poses[index++ % poses.size()]));
  }
}
BENCHMARK(cast_one_scan)->Name("simulation/cast_scan_360")->Unit(benchmark::kMicrosecond);

void draw_map(benchmark::State& state) {
  const simulation::RayCaster caster(simulation::make_corridor({}));
  const std::vector<Pose2> poses = drive_along(static_cast<std::size_t>(state.range(0)));
  std::vector<LaserScan> scans;
  scans.reserve(poses.size());
  for (const Pose2& pose : poses) scans.push_back(cast_scan(caster, pose));
  std::vector<mapping::PosedScan> posed;
  posed.reserve(poses.size());
  for (std::size_t index = 0; index < poses.size(); ++index) {
    posed.push_back({poses[index], &scans[index]});
  }
  for (auto _ : state) benchmark::DoNotOptimize(mapping::build_occupancy_map(posed, {}));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(draw_map)
    ->Name("mapping/occupancy_scans")
    ->Arg(10)
    ->Arg(100)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace corridor
