#include "bench/runner/case_data.hpp"

#include <utility>

#include "datasets/simulation/scenario.hpp"
#include "datasets/simulation/simulate.hpp"

namespace corridor::runner {
namespace {

Result<CaseData> simulated_data(const CaseSpec& spec) {
  const Result<std::filesystem::path> path = simulation::find_scenario(spec.data_source);
  if (!path) return tl::make_unexpected(path.error());
  const Result<simulation::Scenario> scenario = simulation::read_scenario(*path);
  if (!scenario) return tl::make_unexpected(scenario.error());
  simulation::Simulated simulated = simulation::simulate(*scenario, spec.data_seed.value_or(1));
  CaseData data;
  data.log = std::move(simulated.log);
  data.world = std::move(simulated.world);
  data.simulation_truth = std::move(simulated.truth);
  return data;
}

Result<CaseData> recorded_data(const CaseSpec& spec, const catalog::DataDirs& dirs) {
  Result<catalog::LoadedDataset> loaded = catalog::load_dataset(spec.data_source, dirs);
  if (!loaded) return tl::make_unexpected(loaded.error());
  CaseData data;
  data.log = std::move(loaded->log);
  if (loaded->relations) data.relations = std::move(*loaded->relations);
  if (loaded->world_file) {
    Result<simulation::SimulationTruth> truth = simulation::read_truth(*loaded->world_file);
    if (!truth) return tl::make_unexpected(truth.error());
    data.world = simulation::make_corridor(truth->world);
    data.simulation_truth = std::move(*truth);
  }
  return data;
}

}  // namespace

Result<CaseData> load_case_data(const CaseSpec& spec, const catalog::DataDirs& dirs) {
  return spec.data_kind == DataKind::kSimulated ? simulated_data(spec) : recorded_data(spec, dirs);
}

}  // namespace corridor::runner
