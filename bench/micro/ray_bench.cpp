// Ray casting for the simulator: rays per second through worlds of walls, beside MRPT's ray tracing
// through an occupancy grid of the same world at 5 cm.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "baselines/mrpt/grid_rays.hpp"
#include "datasets/simulation/ray_casting.hpp"
#include "datasets/simulation/scenario.hpp"

namespace corridor {
namespace {

constexpr std::size_t kNumBeams = 360;
constexpr double kResolution_m = 0.05;

simulation::World world_of(const char* scenario) {
  const auto loaded = simulation::load_scenario(scenario);
  return loaded ? loaded->world : simulation::World{};
}

// Poses spread over the route's first leg, or the paper corridor's first arm.
std::vector<Pose2> poses_in(const simulation::World& world) {
  const Eigen::Vector2d from_m = world.corridor ? Eigen::Vector2d(2.5, 2.5) : world.route_m[0];
  const Eigen::Vector2d to_m = world.corridor ? Eigen::Vector2d(18.5, 2.5) : world.route_m[1];
  std::vector<Pose2> poses;
  for (int i = 0; i < 128; ++i) {
    const Eigen::Vector2d at_m = from_m + (to_m - from_m) * (i + 0.5) / 128;
    poses.emplace_back(at_m.x(), at_m.y(), 0.05 * i);
  }
  return poses;
}

// Every cell that a wall passes is occupied, every other one free.
GridMap drawn(const simulation::World& world) {
  Eigen::Vector2d lower_m = Eigen::Vector2d::Constant(1e9), upper_m = -lower_m;
  const auto outlines = simulation::outlines_m(world);
  for (const auto& line : outlines) {
    for (const Eigen::Vector2d& point_m : line) {
      lower_m = lower_m.cwiseMin(point_m);
      upper_m = upper_m.cwiseMax(point_m);
    }
  }
  lower_m.array() -= 0.5;
  const Eigen::Vector2d cells = ((upper_m - lower_m).array() + 0.5) / kResolution_m;
  GridMap map(kResolution_m, lower_m, static_cast<int>(cells.x()), static_cast<int>(cells.y()));
  for (int row = 0; row < map.num_rows(); ++row) {
    for (int column = 0; column < map.num_columns(); ++column) {
      map.at(column, row) = {-4, 0, true};
    }
  }
  for (const auto& line : outlines) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Eigen::Vector2d along = line[i + 1] - line[i];
      const int num_steps = static_cast<int>(std::ceil(along.norm() / (kResolution_m / 4)));
      for (int k = 0; k <= num_steps; ++k) {
        const Eigen::Vector2i cell = map.cell_of(line[i] + along * k / std::max(num_steps, 1));
        if (map.contains(cell.x(), cell.y())) map.at(cell.x(), cell.y()) = {4, 1, true};
      }
    }
  }
  return map;
}

void count_rays(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kNumBeams));
}

void cast_walls(benchmark::State& state, const char* scenario, double max_m) {
  const simulation::World world = world_of(scenario);
  const simulation::RayCaster caster(world);
  const std::vector<Pose2> poses = poses_in(world);
  std::size_t index = 0;
  for (auto _ : state) {
    const Pose2& pose = poses[index++ % poses.size()];
    for (std::size_t beam = 0; beam < kNumBeams; ++beam) {
      const double angle_rad =
          pose.theta_rad() + 2 * std::numbers::pi * static_cast<double>(beam) / kNumBeams;
      benchmark::DoNotOptimize(caster.cast(pose.translation_m(), angle_rad, max_m));
    }
  }
  count_rays(state);
}

void cast_grid_mrpt(benchmark::State& state, const char* scenario, double max_m) {
  const simulation::World world = world_of(scenario);
  const mrpt::GridRays rays(drawn(world));
  const std::vector<Pose2> poses = poses_in(world);
  std::size_t index = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(rays.cast(poses[index++ % poses.size()], kNumBeams, max_m));
  }
  count_rays(state);
}

BENCHMARK_CAPTURE(cast_walls, paper_corridor, "paper-corridor", 4.5)
    ->Name("simulation/rays/paper-corridor/4.5m");
BENCHMARK_CAPTURE(cast_grid_mrpt, paper_corridor, "paper-corridor", 4.5)
    ->Name("simulation/rays_mrpt_grid/paper-corridor/4.5m");
BENCHMARK_CAPTURE(cast_walls, paper_corridor_far, "paper-corridor", 30)
    ->Name("simulation/rays/paper-corridor/30m");
BENCHMARK_CAPTURE(cast_grid_mrpt, paper_corridor_far, "paper-corridor", 30)
    ->Name("simulation/rays_mrpt_grid/paper-corridor/30m");
BENCHMARK_CAPTURE(cast_walls, floor, "floor", 30)->Name("simulation/rays/floor/30m");
BENCHMARK_CAPTURE(cast_grid_mrpt, floor, "floor", 30)->Name("simulation/rays_mrpt_grid/floor/30m");

}  // namespace
}  // namespace corridor
