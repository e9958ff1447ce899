#include "bench/runner/run_case.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/metrics/accuracy_bound.hpp"
#include "bench/metrics/consistency.hpp"
#include "bench/metrics/score_case.hpp"
#include "bench/results/digest.hpp"
#include "bench/results/machine.hpp"
#include "bench/runner/build_id.hpp"
#include "bench/runner/case_data.hpp"
#include "bench/runner/case_files.hpp"
#include "bench/runner/case_system.hpp"
#include "bench/runner/cost.hpp"
#include "bench/runner/detection.hpp"
#include "bench/runner/drive.hpp"
#include "bench/runner/git_revision.hpp"
#include "bench/runner/overrides.hpp"
#include "bench/runner/run_graph_case.hpp"
#include "bench/runner/systems.hpp"
#include "slam/mapping/occupancy_mapper.hpp"

namespace corridor::runner {
namespace {

using results::CaseStatus;
using results::RunResult;

// How the base moved during a sweep, as the trajectory has it; none where it does not reach.
Eigen::Vector3d sweep_twist(const LaserScan& scan, const Pose2& T_map_base,
                            const Trajectory& trajectory) {
  if (scan.duration_s == 0) return Eigen::Vector3d::Zero();
  const auto T_map_last = trajectory.interpolate(add_seconds(scan.stamp, scan.duration_s));
  if (!T_map_last) return Eigen::Vector3d::Zero();
  return T_map_last->minus(T_map_base) / scan.duration_s;
}

// The map that one common mapper makes of a trajectory: every scan at its pose, its sweep drawn
// along the trajectory, scans without a pose left out.
GridMap render_map(const SensorLog& log, const Trajectory& trajectory) {
  std::vector<mapping::PosedScan> scans;
  for (const SensorEvent& event : log.events) {
    const auto* scan = std::get_if<LaserScan>(&event);
    if (scan == nullptr) continue;
    const std::optional<Pose2> T_map_base = trajectory.interpolate(scan->stamp);
    if (!T_map_base) continue;
    scans.push_back({*T_map_base, scan, sweep_twist(*scan, *T_map_base, trajectory)});
  }
  return mapping::build_occupancy_map(scans, mapping::OccupancyMapperParams{});
}

std::vector<Timestamp> scan_stamps(const SensorLog& log) {
  std::vector<Timestamp> stamps;
  for (const SensorEvent& event : log.events) {
    if (std::holds_alternative<LaserScan>(event)) stamps.push_back(stamp_of(event));
  }
  return stamps;
}

// Range of the map's scoring: what the sensor may have seen.
double lidar_range_m(const CaseData& data) {
  return data.simulation_truth && data.simulation_truth->range_max_m > 0
             ? data.simulation_truth->range_max_m
             : data.log.robot.lidar.range_max_m;
}

// Remarks for the reader of the scores.
std::vector<std::string> score(const CaseData& data, const Drive& run,
                               const std::optional<GridMap>& rendered_map, RunResult& result) {
  const std::vector<Timestamp> stamps = scan_stamps(data.log);
  metrics::CaseEvidence evidence;
  evidence.online_trajectory = &run.online;
  if (run.estimate) {
    evidence.final_trajectory = &run.estimate->trajectory;
    if (run.estimate->map) evidence.own_map = &*run.estimate->map;
  }
  if (rendered_map) evidence.rendered_map = &*rendered_map;
  evidence.scan_stamps = stamps;
  if (data.log.truth) evidence.truth_world = &*data.log.truth;
  evidence.relations = data.relations;
  if (data.world) evidence.world = &*data.world;
  evidence.lidar_range_m = lidar_range_m(data);
  std::vector<std::string> remarks = metrics::score_case(evidence, {}, result);
  if (!data.log.truth && data.relations.empty()) {
    remarks.emplace_back("not scored: the data set has neither true poses nor relations");
  }
  if (data.simulation_truth) score_detection(run.health, *data.simulation_truth, result);
  return remarks;
}

// What the data allow, and whether a system that solved a graph knows how wrong it is. Both need
// poses that are true and not another program's.
void score_against_theory(const CaseData& data, const SlamSystem& system, RunResult& result) {
  if (data.simulation_truth && data.world) {
    if (const auto bound =
            metrics::accuracy_bound(data.log, *data.world, data.simulation_truth->slips)) {
      result.bound_position_rmse_m = bound->position_rmse_m;
      result.bound_angle_rmse_deg = bound->angle_rmse_deg;
    }
  }
  const auto* source = dynamic_cast<const graph::GraphSource*>(&system);
  if (source == nullptr || !data.log.truth || data.log.provenance.is_truth_reference) return;
  if (const auto consistency = metrics::score_consistency(*source, *data.log.truth)) {
    result.nees_mean = consistency->nees_mean;
    result.nees_last = consistency->nees_last;
    result.nees_dof = consistency->dof;
  }
}

std::optional<std::int64_t> whole(const std::map<std::string, double>& counters,
                                  const std::string& name) {
  const auto found = counters.find(name);
  if (found == counters.end()) return std::nullopt;
  return static_cast<std::int64_t>(found->second);
}

void take_counters(const SlamEstimate& estimate, RunResult& result) {
  result.counters = estimate.counters;
  result.factors = whole(estimate.counters, "factors");
  result.variables = whole(estimate.counters, "variables");
  result.relinearised = whole(estimate.counters, "relinearised");
  if (const auto chi2 = estimate.counters.find("chi2"); chi2 != estimate.counters.end()) {
    result.chi2 = chi2->second;
  }
}

// A run that ended is lost all the same when its map is of no use: the mean error of relations set
// up by hand is ten times what published systems reach, or the position error a quarter of the
// path.
constexpr double kLostRelationError_m = 0.5;
constexpr double kLostPathRatio = 0.25;

std::optional<std::string> why_lost(const CaseData& data, const RunResult& result) {
  const auto relation_m = result.final_relations.relations_translation_mean_m;
  if (relation_m && *relation_m > kLostRelationError_m) {
    return fmt::format("lost: mean relation error {:.3f} m, expected at most {} m", *relation_m,
                       kLostRelationError_m);
  }
  const auto position_m = result.final_scores.position_rmse_m;
  if (!position_m || !data.log.truth) return std::nullopt;
  const double limit_m = kLostPathRatio * data.log.truth->path_length_m();
  if (*position_m <= limit_m) return std::nullopt;
  return fmt::format(
      "lost: position RMSE {:.3f} m, expected at most {:.3f} m, a quarter of the path", *position_m,
      limit_m);
}

void settle_status(const CaseData& data, const Drive& run, RunResult& result) {
  result.status = run.status;
  result.status_message = run.status_message;
  if (run.status != CaseStatus::kOk) return;
  if (const std::optional<std::string> reason = why_lost(data, result)) {
    result.status = CaseStatus::kDiverged;
    result.status_message = *reason;
    return;
  }
  if (!result.poses_expected || !result.poses_matched) return;
  if (*result.poses_matched < *result.poses_expected) {
    result.status = CaseStatus::kPartial;
    result.status_message =
        fmt::format("{} of {} poses are missing", *result.poses_expected - *result.poses_matched,
                    *result.poses_expected);
  }
}

std::string log_text(const CaseData& data, const RunResult& result) {
  std::string text = fmt::format(
      "case {}\nsystem {}@{} seed {}\ndata {} ({}, {}): {} scans, {} wheel samples, {} inertial "
      "samples, {:.1f} s\n",
      result.case_id, result.system, result.profile, result.system_seed, result.dataset,
      data.log.provenance.format, data.log.provenance.source, data.log.num_scans(),
      data.log.num_wheel_samples(), data.log.num_imu_samples(), data.log.duration_s());
  for (const std::string& note : data.log.provenance.notes) text += "data note: " + note + "\n";
  for (const std::string& note : result.notes) text += "score note: " + note + "\n";
  for (const auto& [name, value] : result.counters) text += fmt::format("{} {}\n", name, value);
  text += fmt::format("status {}{}{}\n", to_text(result.status),
                      result.status_message.empty() ? "" : ": ", result.status_message);
  return text;
}

}  // namespace

RunResult record_of(const CaseSpec& spec, std::optional<int> jobs) {
  RunResult result;
  result.case_id = case_id(spec);
  result.suite = spec.suite;
  result.system = spec.system;
  result.profile = spec.profile;
  result.backend = spec.backend;
  result.dataset = spec.dataset;
  result.data_kind = std::string(to_text(spec.data_kind));
  result.data_source = spec.data_source;
  if (!spec.data_digest.empty()) result.data_digest = spec.data_digest;
  result.data_seed = spec.data_seed;
  result.system_seed = spec.system_seed;
  result.threads = spec.threads;
  result.jobs = jobs;
  result.overrides = spec.overrides;
  result.git_revision = git_revision();
  result.build_id = build_id();
  result.machine_id = results::this_machine().machine_id;
  if (const Result<SystemInfo> info = find_system(spec.system)) {
    const CaseOverrides overrides = split_overrides(spec.overrides, spec.backend);
    const Result<ParamValues> values = info->resolve(spec.profile, overrides.system);
    if (values) result.parameters = *values;
    for (const auto& [name, value] : overrides.back_end) {
      result.parameters[*spec.backend + "." + name] = value;
    }
  }
  std::string text;
  for (const auto& [name, value] : result.parameters) text += fmt::format("{} = {}\n", name, value);
  result.parameters_hash = results::short_digest(text);
  return result;
}

tl::expected<RunResult, CaseFailure> run_case(const CaseSpec& spec, const catalog::DataDirs& dirs,
                                              const std::filesystem::path& out,
                                              std::optional<int> jobs) {
  if (spec.data_kind == DataKind::kGraph) return run_graph_case(spec, dirs, out, jobs);
  const Result<CaseData> data = load_case_data(spec, dirs);
  if (!data) return tl::make_unexpected(CaseFailure{data.error()});
  const Result<std::unique_ptr<SlamSystem>> system = make_system(spec, *data);
  if (!system) return tl::make_unexpected(CaseFailure{system.error()});

  const Drive run = drive(**system, data->log);

  RunResult result = record_of(spec, jobs);
  std::optional<GridMap> rendered_map;
  if (run.estimate) {
    take_counters(*run.estimate, result);
    rendered_map = render_map(data->log, run.estimate->trajectory);
  }
  if (data->log.truth) {
    result.true_poses = data->log.provenance.is_truth_reference ? "reference" : "truth";
  }
  if (run.estimate) score_against_theory(*data, **system, result);
  result.notes = score(*data, run, rendered_map, result);
  for (const std::string& line : data->suspicions)
    result.notes.push_back("suspicious data: " + line);
  score_cost(run, (*system)->stage_clock(), data->log.duration_s(), result);
  settle_status(*data, run, result);

  const Result<void> written = write_folder_atomically(
      case_folder(out, result.case_id), [&](const std::filesystem::path& folder) -> Result<void> {
        const CaseOutput output{&*data, &run, system->get(),
                                rendered_map ? &*rendered_map : nullptr};
        if (auto done = write_output(folder, output); !done) return done;
        return write_record(folder, spec, result, log_text(*data, result));
      });
  if (!written) return tl::make_unexpected(CaseFailure{written.error(), true});
  return result;
}

}  // namespace corridor::runner
