#include "bench/runner/case_data.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "bench/metrics/relations.hpp"
#include "bench/metrics/score_case.hpp"
#include "datasets/formats/lidar_clock.hpp"
#include "datasets/formats/log_health.hpp"
#include "datasets/formats/log_io.hpp"
#include "datasets/simulation/scenario.hpp"
#include "datasets/simulation/simulate.hpp"

namespace corridor::runner {
namespace {

// Intervals of scans carry the scans' stamps, in whole nanoseconds.
void move_degenerate(double lidar_time_offset_s, simulation::SimulationTruth& truth) {
  if (lidar_time_offset_s == 0 || !truth.degenerate) return;
  const auto moved_s = [lidar_time_offset_s](double stamp_s) {
    return to_seconds(add_seconds(timestamp_from_seconds(stamp_s), -lidar_time_offset_s));
  };
  for (simulation::DegenerateInterval& interval : *truth.degenerate) {
    interval.begin_s = moved_s(interval.begin_s);
    interval.end_s = moved_s(interval.end_s);
  }
}

Result<CaseData> simulated_data(const CaseSpec& spec) {
  const Result<simulation::Scenario> scenario = simulation::load_scenario(spec.data_source);
  if (!scenario) return tl::make_unexpected(scenario.error());
  Result<simulation::Simulated> simulated =
      simulation::simulate(*scenario, spec.data_seed.value_or(1));
  if (!simulated) return tl::make_unexpected(simulated.error());
  CaseData data;
  data.log = std::move(simulated->log);
  data.world = std::move(simulated->world);
  data.simulation_truth = std::move(simulated->truth);
  move_degenerate(formats::move_onto_wheel_clock(data.log, nullptr), *data.simulation_truth);
  return data;
}

Result<CaseData> recorded_data(const CaseSpec& spec, const catalog::DataDirs& dirs) {
  Result<catalog::LoadedDataset> loaded = load_scorable_dataset(spec.data_source, dirs);
  if (!loaded) return tl::make_unexpected(loaded.error());
  CaseData data;
  data.log = std::move(loaded->log);
  data.suspicions = formats::examine(data.log).suspicions;
  if (loaded->relations) data.relations = std::move(*loaded->relations);
  if (loaded->world_file) {
    Result<simulation::SimulationTruth> truth = simulation::read_truth(*loaded->world_file);
    if (!truth) return tl::make_unexpected(truth.error());
    data.world = truth->world;
    data.simulation_truth = std::move(*truth);
    move_degenerate(loaded->lidar_time_offset_s, *data.simulation_truth);
  }
  return data;
}

Trajectory scan_trajectory(const SensorLog& log) {
  Trajectory scans;
  for (const SensorEvent& event : log.events) {
    // A stamp that repeats the last one cannot be a second scan to be matched.
    if (std::holds_alternative<LaserScan>(event)) {
      static_cast<void>(scans.append({stamp_of(event), Pose2(), std::nullopt}));
    }
  }
  return scans;
}

}  // namespace

Result<void> check_truth(const SensorLog& log) {
  const Trajectory scans = scan_trajectory(log);
  if (!log.truth || log.truth->empty() || scans.empty()) return {};
  const metrics::ScoringOptions scoring;
  const auto matched = metrics::associate(scans, *log.truth, scoring.association, scoring.max_dt_s);
  if (!matched.pairs.empty()) return {};
  const auto span = [](const Trajectory& trajectory) {
    return fmt::format("{:.3f} s to {:.3f} s", to_seconds(trajectory[0].stamp),
                       to_seconds(trajectory[trajectory.size() - 1].stamp));
  };
  return fail(
      ErrorCode::kInvalid,
      fmt::format("no stamp in common with the scans (truth: {}, scans: {})", span(*log.truth),
                  span(scans)),
      formats::sidecar_of(log.provenance.source, ".tum").string(),
      fmt::format("stamps within {} s of those of {}", scoring.max_dt_s, log.provenance.source));
}

Result<void> check_relations(const SensorLog& log,
                             const std::vector<formats::Relation>& relations) {
  const Trajectory scans = scan_trajectory(log);
  if (relations.empty() || scans.empty()) return {};
  const double max_dt_s = metrics::ScoringOptions{}.max_dt_s;
  const auto scores = metrics::score_relations(scans, relations, max_dt_s);
  if (scores.relations_used.value_or(0) > 0) return {};
  return fail(ErrorCode::kInvalid,
              fmt::format("none of {} relations has scans at both of its times", relations.size()),
              formats::sidecar_of(log.provenance.source, ".relations").string(),
              fmt::format("stamps within {} s of those of {}", max_dt_s, log.provenance.source));
}

Result<catalog::LoadedDataset> load_dataset(const std::string& name_or_path,
                                            const catalog::DataDirs& dirs,
                                            const catalog::LoadOptions& options) {
  Result<catalog::LoadedDataset> loaded = catalog::load_dataset(name_or_path, dirs, options);
  std::error_code ignored;
  if (!loaded && loaded.error().code == ErrorCode::kNotFound &&
      std::filesystem::is_directory(name_or_path, ignored)) {
    return fail(ErrorCode::kInvalid, "this is a folder", name_or_path,
                "a log file, or the name of a data set");
  }
  if (!loaded || !loaded->world_file) return loaded;
  if (const auto world = simulation::read_truth(*loaded->world_file); !world) {
    return tl::make_unexpected(world.error());
  }
  return loaded;
}

Result<catalog::LoadedDataset> load_scorable_dataset(const std::string& name_or_path,
                                                     const catalog::DataDirs& dirs) {
  Result<catalog::LoadedDataset> loaded = load_dataset(name_or_path, dirs);
  if (!loaded) return loaded;
  if (const Result<void> good = check_truth(loaded->log); !good) {
    return tl::make_unexpected(good.error());
  }
  if (!loaded->relations) return loaded;
  if (const Result<void> good = check_relations(loaded->log, *loaded->relations); !good) {
    return tl::make_unexpected(good.error());
  }
  return loaded;
}

Result<CaseData> load_case_data(const CaseSpec& spec, const catalog::DataDirs& dirs) {
  return spec.data_kind == DataKind::kSimulated ? simulated_data(spec) : recorded_data(spec, dirs);
}

}  // namespace corridor::runner
