#include "tests/reports/synthetic_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include "bench/results/machine.hpp"
#include "bench/results/result_json.hpp"
#include "bench/results/results_store.hpp"
#include "datasets/formats/maps/ros_map.hpp"
#include "datasets/formats/trajectories/tum.hpp"
#include "datasets/simulation/truth.hpp"
#include "datasets/simulation/world.hpp"
#include "slam/core/stage_clock.hpp"

namespace corridor::reports::testing {
namespace {

namespace fs = std::filesystem;
using results::RunResult;

constexpr double kSpeed_mps = 0.5;
constexpr double kFirstArm_m = 16;
constexpr double kSecondArm_m = 9.5;
constexpr double kStep_s = 0.2;
const Pose2 kStart(2.5, 2.5, 0.1);

template <class T>
void require(const Result<T>& result) {
  if (!result) throw std::runtime_error(result.error().to_line());
}

// What is left of a length along the first arm.
double stretch_of(const SyntheticRun& run, const SyntheticSystem& system, std::uint64_t seed) {
  const double phase = static_cast<double>(seed % 7) / 6 - 0.5;
  const double spread = run.num_worlds > 1 ? system.spread_ratio * phase : 0;
  return 1 - system.shrink_ratio * (1 + spread * 10);
}

// Shrinks the world along the first arm, seen from the start.
Eigen::Vector2d shrunk(const Eigen::Vector2d& point_m, double stretch_ratio) {
  return {kStart.x_m() + stretch_ratio * (point_m.x() - kStart.x_m()), point_m.y()};
}

Pose2 true_pose(double time_s) {
  const double way_m = kSpeed_mps * time_s;
  if (way_m < kFirstArm_m) return {kStart.x_m() + way_m, 2.5 + 0.3 * std::sin(way_m), 0.1};
  return {kStart.x_m() + kFirstArm_m, 2.5 + way_m - kFirstArm_m, std::numbers::pi / 2};
}

Trajectory true_trajectory() {
  Trajectory trajectory;
  const double end_s = (kFirstArm_m + kSecondArm_m) / kSpeed_mps;
  for (double time_s = 0; time_s <= end_s; time_s += kStep_s) {
    if (!trajectory.append({timestamp_from_seconds(time_s), true_pose(time_s), {}})) break;
  }
  return trajectory;
}

// In the map frame, which is the robot's first pose.
Trajectory estimated_trajectory(double stretch_ratio) {
  Trajectory trajectory;
  const Pose2 T_map_world = kStart.inverse();
  const Trajectory truth = true_trajectory();
  for (const TrajectoryPose& pose : truth.poses()) {
    const Eigen::Vector2d point_m = shrunk(pose.T_map_base.translation_m(), stretch_ratio);
    const Pose2 T_world_base(point_m.x(), point_m.y(), pose.T_map_base.theta_rad());
    if (!trajectory.append({pose.stamp, T_map_world * T_world_base, {}})) break;
  }
  return trajectory;
}

GridMap estimated_map(double stretch_ratio) {
  GridMap map(0.1, {-6, -8}, 280, 280);
  const Pose2 T_map_world = kStart.inverse();
  const auto put = [&](const Eigen::Vector2d& point_world_m, float log_odds) {
    const Eigen::Vector2i cell = map.cell_of(T_map_world * shrunk(point_world_m, stretch_ratio));
    if (!map.contains(cell.x(), cell.y())) return;
    map.at(cell.x(), cell.y()) = {log_odds, log_odds > 0 ? 1.0F : 0.0F, true};
  };
  const simulation::CorridorShape shape;
  for (double x_m = 0; x_m <= shape.b_m; x_m += 0.04) {
    for (double y_m = 0; y_m <= shape.a_m; y_m += 0.04) {
      if (y_m < shape.c_m || x_m > shape.b_m - shape.c_m) put({x_m, y_m}, -3);
    }
  }
  for (const simulation::Segment& wall : simulation::make_corridor(shape).walls) {
    for (double ratio = 0; ratio <= 1; ratio += 0.001) {
      put(wall.a_m + ratio * (wall.b_m - wall.a_m), 3);
    }
  }
  return map;
}

void write_files(const SyntheticRun& run, const SyntheticSystem& system, std::uint64_t seed,
                 const fs::path& folder) {
  const double stretch_ratio = stretch_of(run, system, seed);
  require(formats::write_tum(true_trajectory(), folder / "truth.tum"));
  require(formats::write_tum(estimated_trajectory(stretch_ratio), folder / "final.tum"));
  require(formats::write_tum(estimated_trajectory(stretch_ratio), folder / "online.tum"));
  require(formats::write_ros_map(estimated_map(stretch_ratio), folder / "map"));
  simulation::SimulationTruth truth;
  truth.world = simulation::make_corridor({});
  truth.range_max_m = 4.5;
  std::ofstream(folder / "world.toml") << simulation::truth_toml(truth);
}

results::KeyDistances key_distances(double stretch_ratio) {
  const auto distance = [](double true_m, double measured_m) {
    return results::KeyDistance{true_m, measured_m, measured_m - true_m, 0.004, "ok"};
  };
  const double angle_deg = 90 + 4 * (1 - stretch_ratio);
  return {distance(14.5, 14.5 * (0.5 + 0.5 * stretch_ratio)),
          distance(21, 21 * stretch_ratio),
          distance(5, 5 - 0.3 * (1 - stretch_ratio)),
          {90, angle_deg, angle_deg - 90, 0.05, "ok"}};
}

void add_cost(const SyntheticSystem& system, RunResult& result) {
  result.step_p50_us = 400;
  result.step_p95_us = 900;
  result.step_p99_us = 1500;
  result.step_max_us = 2500;
  result.wall_s = 0.6;
  result.cpu_s = 0.59;
  result.peak_rss_mib = 48;
  result.realtime_factor = 85;
  result.stages = {{"predict", 500, 0.02, 30, 60, 80, 110},
                   {"match", 500, 0.35, 300, 700, 900, 1400}};
  if (system.name == "gmapping") result.stages.push_back({"resample", 20, 0.1, 90, 95, 98, 120});
}

}  // namespace

SyntheticRun paper_like_run() {
  SyntheticRun run;
  run.systems = {{"dead-reckoning", 0.02, 0.09},
                 {"gmapping", 0.2, 0.06},
                 {"karto", 0.06, 0.08},
                 {"fusion-paper", 0.02, 0.05},
                 {"fusion", 0.003, 0.05}};
  return run;
}

RunResult synthetic_result(const SyntheticRun& run, const SyntheticSystem& system,
                           std::uint64_t data_seed) {
  const double stretch_ratio = stretch_of(run, system, data_seed);
  RunResult result;
  result.case_id = fmt::format("{}-{}-{}", run.suite, system.name, data_seed);
  result.suite = run.suite;
  result.system = system.name;
  result.profile = "default";
  result.dataset = run.dataset;
  result.data_seed = data_seed;
  result.system_seed = 1;
  result.parameters_hash = "0123abcd";
  result.parameters = {{"match.resolution_m", "0.05"}, {"num_particles", "30"}};
  result.git_revision = "0000000";
  result.machine_id = "machine-of-the-test";
  result.status = results::CaseStatus::kOk;
  result.poses_expected = result.poses_matched = 256;
  result.association = "interpolate";
  result.alignment = "origin";
  const double error_m = 10 * (1 - stretch_ratio);
  result.final_scores.position_rmse_m = error_m;
  result.final_scores.angle_rmse_deg = 0.2 + error_m / 4;
  result.online_scores.position_rmse_m = 1.4 * error_m;
  result.online_scores.angle_rmse_deg = 0.3 + error_m / 3;
  result.own_map.key_distances = key_distances(stretch_ratio);
  result.rendered_map.key_distances = key_distances(stretch_ratio);
  result.own_map.map_chamfer_m = 0.3 * error_m;
  add_cost(system, result);
  return result;
}

SyntheticRun run_of(std::vector<SyntheticSystem> systems) {
  SyntheticRun run;
  run.systems = std::move(systems);
  return run;
}

std::vector<results::RunResult> synthetic_results(const SyntheticRun& run,
                                                  std::uint64_t num_worlds) {
  std::vector<results::RunResult> all;
  for (const SyntheticSystem& system : run.systems) {
    for (std::uint64_t seed = 1; seed <= num_worlds; ++seed) {
      all.push_back(synthetic_result(run, system, seed));
    }
  }
  return all;
}

Cases make_cases(const std::vector<results::RunResult>& results) {
  std::vector<Case> cases;
  for (const results::RunResult& result : results) cases.push_back({result, {}});
  return {std::move(cases), {}, {}};
}

void write_synthetic_run(const SyntheticRun& run, const fs::path& run_dir,
                         const std::vector<RunResult>& extra) {
  fs::create_directories(run_dir);
  std::vector<RunResult> all = extra;
  for (const SyntheticSystem& system : run.systems) {
    for (int world = 1; world <= run.num_worlds; ++world) {
      const auto seed = static_cast<std::uint64_t>(world);
      all.push_back(synthetic_result(run, system, seed));
      if (!run.has_files) continue;
      const fs::path folder = run_dir / "runs" / all.back().case_id;
      fs::create_directories(folder);
      std::ofstream(folder / "result.json") << results::to_json(all.back());
      write_files(run, system, seed, folder);
    }
  }
  auto store = results::ResultsStore::open(run_dir / "results.sqlite");
  require(store);
  require(store->put(all));
  require(
      store->put(results::Machine{"machine-of-the-test", "Test CPU", 2, 4096, "6.1", "gcc 12"}));
}

}  // namespace corridor::reports::testing
