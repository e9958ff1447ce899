// Kernels around scans, in the paper's corridor with the suite's LiDAR: casting one scan of 360
// beams, drawing scans into an occupancy grid.
#include <benchmark/benchmark.h>

#include <numbers>
#include <vector>

#include "datasets/simulation/ray_casting.hpp"
#include "datasets/simulation/world.hpp"
#include "slam/mapping/occupancy_mapper.hpp"

namespace corridor {
namespace {

constexpr std::size_t kNumBeams = 360;
constexpr double kRangeMax_m = 4.5;

// An ideal scan at a pose in the corridor; beams without return are marked as such.
LaserScan cast_scan(const simulation::RayCaster& caster, const Pose2& T_world_base) {
  LaserScan scan;
  scan.angle_increment_rad = 2 * std::numbers::pi / static_cast<double>(kNumBeams);
  scan.range_max_m = kRangeMax_m;
  for (std::size_t beam = 0; beam < kNumBeams; ++beam) {
    const auto range_m = caster.range_m(
        T_world_base.translation_m(), T_world_base.theta_rad() + scan.angle_rad(beam), kRangeMax_m);
    scan.ranges_m.push_back(static_cast<float>(range_m.value_or(kRangeMax_m + 1)));
    scan.is_valid.push_back(range_m.has_value() ? 1 : 0);
  }
  return scan;
}

// Poses along the first arm, 0.1 m apart.
std::vector<Pose2> drive_along(std::size_t num_poses) {
  std::vector<Pose2> poses;
  for (std::size_t index = 0; index < num_poses; ++index) {
    poses.emplace_back(2.5 + 0.1 * static_cast<double>(index), 2.5, 0.01);
  }
  return poses;
}

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
