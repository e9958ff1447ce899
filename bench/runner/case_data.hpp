// The data of a case, simulated or loaded, with everything that is known for scoring.
// A system is shown the events and the robot model only. All stamps are of the wheels' clock
// (datasets/formats/lidar_clock.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/runner/case_spec.hpp"
#include "datasets/catalog/load_dataset.hpp"
#include "datasets/formats/trajectories/relations.hpp"
#include "datasets/simulation/truth.hpp"
#include "datasets/simulation/world.hpp"
#include "slam/core/result.hpp"
#include "slam/core/sensor_log.hpp"

namespace corridor::runner {

struct CaseData {
  SensorLog log;  // truth of its own
  std::vector<formats::Relation> relations;
  std::optional<simulation::World> world;
  std::optional<simulation::SimulationTruth> simulation_truth;
  // What looks wrong in a recorded log or its truth, and may make of a sound system a bad score.
  std::vector<std::string> suspicions;
};

// An Error if the truth of a log, or relations, meet none of its scans: they are of another clock,
// unit or log.
Result<void> check_truth(const SensorLog& log);
Result<void> check_relations(const SensorLog& log, const std::vector<formats::Relation>& relations);

// catalog::load_dataset(), but a folder is told to be one, and LOG.truth.toml must be readable.
Result<catalog::LoadedDataset> load_dataset(const std::string& name_or_path,
                                            const catalog::DataDirs& dirs,
                                            const catalog::LoadOptions& options = {});

// The same for a log that is to be scored: its truth and relations are checked.
Result<catalog::LoadedDataset> load_scorable_dataset(const std::string& name_or_path,
                                                     const catalog::DataDirs& dirs);

Result<CaseData> load_case_data(const CaseSpec& spec, const catalog::DataDirs& dirs);

}  // namespace corridor::runner
