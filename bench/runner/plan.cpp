#include "bench/runner/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "bench/results/digest.hpp"
#include "bench/runner/case_data.hpp"
#include "bench/runner/data_kind.hpp"
#include "bench/runner/graph_of.hpp"
#include "bench/runner/name_data.hpp"
#include "bench/runner/systems.hpp"
#include "datasets/catalog/load_graph.hpp"
#include "datasets/simulation/scenario.hpp"

namespace corridor::runner {
namespace {

// One spelling for each file; a case may run from another folder.
std::string absolute_source(const std::filesystem::path& path) {
  return std::filesystem::absolute(path).lexically_normal().string();
}

// `source` is a plain scenario or one member of a family.
Result<DataItem> scenario_item(const std::string& source) {
  const Result<std::filesystem::path> path = simulation::find_scenario(source);
  if (!path) return tl::make_unexpected(path.error());
  const Result<simulation::Scenario> scenario = simulation::load_scenario(source);
  if (!scenario) return tl::make_unexpected(scenario.error());
  const bool is_path = path->stem() != source.substr(0, source.rfind('@'));
  std::string values = simulation::world_toml(scenario->world);
  for (const auto& [key, value] : simulation::scenario_values(*scenario)) {
    values += fmt::format("{} = {}\n", key, value);
  }
  return DataItem{DataKind::kSimulated,
                  scenario->name,
                  is_path ? absolute_source(source) : source,
                  results::short_digest(values),
                  {}};
}

Result<DataItem> dataset_item(const std::string& source, const catalog::DataDirs& dirs) {
  const Result<catalog::LoadedDataset> loaded = load_scorable_dataset(source, dirs);
  if (!loaded) return tl::make_unexpected(loaded.error());
  const bool is_name = loaded->name == source;
  return DataItem{DataKind::kRecorded, loaded->name, is_name ? source : absolute_source(source),
                  loaded->digest, sensors_of(loaded->log)};
}

Result<DataItem> graph_item(const std::string& source, const catalog::DataDirs& dirs,
                            const catalog::Catalog& known) {
  const Result<catalog::LoadedGraph> loaded = catalog::load_graph(source, dirs, known);
  if (!loaded) return tl::make_unexpected(loaded.error());
  const bool is_name = loaded->name == source;
  return DataItem{DataKind::kGraph,
                  loaded->name,
                  is_name ? source : absolute_source(source),
                  loaded->digest,
                  {}};
}

// What a system makes of a scenario or log: those decide what it is, as does the system, which runs
// when the case does. An Error kNotFound: also a log without the sensors that the system needs.
Result<DataItem> graph_of_item(const std::string& source, const catalog::DataDirs& dirs,
                               const catalog::Catalog& known) {
  Result<GraphOf> graph = graph_of_from(source, known);
  if (!graph) return tl::make_unexpected(graph.error());
  const Result<DataItem> data = graph->data_kind == DataKind::kSimulated
                                    ? scenario_item(graph->data)
                                    : dataset_item(graph->data, dirs);
  if (!data) return data;
  const std::string& system = graph->system.system;
  if (const auto missing = missing_sensor(*find_system(system), data->sensors)) {
    return fail(ErrorCode::kNotFound, fmt::format("{} needs {}", system, *missing), source,
                "a log with readings of each sensor that it needs");
  }
  graph->data = data->source;
  const std::string name = to_text(*graph);
  return DataItem{DataKind::kGraph, name, name, data->digest, {}};
}

class Planner {
 public:
  Planner(const Suite& suite, const PlanOptions& options) : suite_(suite), options_(options) {}

  Result<Plan> plan(const catalog::DataDirs& dirs) {
    const Result<catalog::Catalog> known = catalog::known_datasets(dirs);
    if (!known) return tl::make_unexpected(known.error());
    if (const Result<void> clear = check_names(*known); !clear) {
      return tl::make_unexpected(clear.error());
    }
    for (const std::string& source : suite_.scenarios) {
      const Result<std::vector<std::string>> members = simulation::scenario_members(source);
      if (!members) return tl::make_unexpected(members.error());
      for (const std::string& member : *members) {
        const Result<DataItem> item = scenario_item(member);
        if (!item) return tl::make_unexpected(item.error());
        items_.push_back(*item);
      }
    }
    for (const std::string& source : suite_.datasets) {
      if (const auto added = add_dataset(source, dirs, *known); !added) {
        return tl::make_unexpected(added.error());
      }
    }
    for (const DataItem& item : with_own_names(std::move(items_))) {
      item.kind == DataKind::kSimulated ? add_simulated(item) : add_given(item);
    }
    return std::move(plan_);
  }

 private:
  [[nodiscard]] Result<void> check_names(const catalog::Catalog& known) const {
    for (const auto* sources : {&suite_.scenarios, &suite_.datasets}) {
      for (const std::string& source : *sources) {
        if (const Result<void> clear = check_one_meaning(source, known); !clear) return clear;
        if (!is_graph_of(source)) continue;
        const Result<GraphOf> graph = graph_of_from(source, known);
        if (!graph) return tl::make_unexpected(graph.error());
      }
    }
    return {};
  }

  Result<void> add_dataset(const std::string& source, const catalog::DataDirs& dirs,
                           const catalog::Catalog& known) {
    const bool is_graph = is_graph_of(source) || catalog::is_graph_name(source, known);
    const Result<DataItem> item = is_graph_of(source) ? graph_of_item(source, dirs, known)
                                  : is_graph          ? graph_item(source, dirs, known)
                                                      : dataset_item(source, dirs);
    if (item) {
      items_.push_back(*item);
    } else if (options_.must_load_data) {
      return tl::make_unexpected(item.error());
    } else if (item.error().code == ErrorCode::kNotFound) {
      plan_.skipped.push_back(fmt::format("{}: skipped: {}", source, item.error().to_line()));
    } else {
      // Broken data are a row of every system, not a gap.
      items_.push_back({is_graph ? DataKind::kGraph : DataKind::kRecorded, source, source, "", {}});
    }
    return {};
  }

  void add_simulated(const DataItem& item) {
    for (int i = 0; i < suite_.num_seeds; ++i) {
      const std::uint64_t seed = suite_.first_seed + static_cast<std::uint64_t>(i);
      for (const SystemChoice& choice : suite_.systems) add(item, choice, seed, seed);
    }
  }

  // A recorded log, or a graph: every seed is a repeat, for those whom it matters to.
  void add_given(const DataItem& item) {
    for (int i = 0; i < suite_.num_seeds; ++i) {
      const std::uint64_t seed = suite_.first_seed + static_cast<std::uint64_t>(i);
      for (const SystemChoice& choice : suite_.systems) {
        const bool is_stochastic = find_system(choice.system)->is_stochastic;
        if (i == 0 || is_stochastic) add(item, choice, std::nullopt, seed);
      }
    }
  }

  void add(const DataItem& item, const SystemChoice& choice, std::optional<std::uint64_t> data_seed,
           std::uint64_t system_seed) {
    const Result<SystemInfo> info = find_system(choice.system);
    if (const auto reason = why_not(*info, item)) {
      skip(fmt::format("{} on {}: skipped: {}", choice.system, item.name, *reason));
      return;
    }
    if (const auto reason = why_unfit_here(*info, choice, item)) {
      skip(fmt::format("{}@{} on {}: skipped: {}", choice.system, choice.profile, item.name,
                       *reason));
      return;
    }
    CaseSpec spec;
    spec.suite = suite_.name;
    spec.system = choice.system;
    spec.profile = choice.profile;
    spec.data_kind = item.kind;
    spec.dataset = item.name;
    spec.data_source = item.source;
    spec.data_seed = data_seed;
    spec.system_seed = system_seed;
    spec.threads = suite_.threads;
    spec.limits = suite_.limits;
    spec.data_digest = item.digest;
    const std::vector<std::string>& backends = suite_.backends_for(choice);
    if (!info->default_backend || backends.empty()) {
      spec.backend = info->default_backend;
      spec.overrides = overrides_of_case(suite_, choice.system, spec.backend);
      plan_.cases.push_back(spec);
      return;
    }
    for (const std::string& backend : backends) {
      if (const auto reason = why_unfit_for(*info, choice, backend)) {
        skip(fmt::format("{}@{} with {}: skipped: {}", choice.system, choice.profile, backend,
                         *reason));
        continue;
      }
      spec.backend = backend;
      spec.overrides = overrides_of_case(suite_, choice.system, spec.backend);
      plan_.cases.push_back(spec);
    }
  }

  static std::optional<std::string> why_not(const SystemInfo& info, const DataItem& item) {
    const bool is_graph = item.kind == DataKind::kGraph;
    if (is_graph && !info.takes_graphs()) return "needs a log, and this is a pose graph";
    if (!is_graph && info.takes_graphs()) return "needs a pose graph, and this is a log";
    const auto missing = missing_sensor(info, item.sensors);
    if (!missing) return std::nullopt;
    return fmt::format("needs {}, and the log has none", *missing);
  }

  // Of systems that take graphs. Parameters that are wrong are the case's to refuse.
  [[nodiscard]] std::optional<std::string> why_unfit_here(const SystemInfo& info,
                                                          const SystemChoice& choice,
                                                          const DataItem& item) const {
    const std::optional<GraphTask> task = graph_task_of(info, choice);
    return task ? why_unfit(*task, is_graph_of(item.source)) : std::nullopt;
  }

  [[nodiscard]] std::optional<std::string> why_unfit_for(const SystemInfo& info,
                                                         const SystemChoice& choice,
                                                         const std::string& backend) const {
    const std::optional<GraphTask> task = graph_task_of(info, choice);
    const std::optional<BackEndInfo> known = find_back_end(backend);
    return task && known ? why_unfit(*task, *known) : std::nullopt;
  }

  [[nodiscard]] std::optional<GraphTask> graph_task_of(const SystemInfo& info,
                                                       const SystemChoice& choice) const {
    if (!info.takes_graphs()) return std::nullopt;
    Result<GraphTask> task =
        info.graph_task(choice.profile, overrides_of_case(suite_, choice.system, std::nullopt));
    return task ? std::optional(std::move(*task)) : std::nullopt;
  }

  // Once, though every seed and profile meets it again.
  void skip(const std::string& line) {
    auto& lines = plan_.skipped;
    if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
  }

  const Suite& suite_;
  PlanOptions options_;
  std::vector<DataItem> items_;
  Plan plan_;
};

}  // namespace

Result<Plan> make_plan(const Suite& suite, const catalog::DataDirs& dirs,
                       const PlanOptions& options) {
  return Planner(suite, options).plan(dirs);
}

}  // namespace corridor::runner
