#include "bench/runner/data_kind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "bench/runner/graph_of.hpp"
#include "datasets/catalog/load_graph.hpp"
#include "datasets/simulation/scenario.hpp"
#include "slam/core/nearest_names.hpp"

namespace corridor::runner {
namespace {

namespace fs = std::filesystem;

bool is_scenario_name(const std::string& name) {
  const std::vector<fs::path> paths = simulation::list_scenarios();
  return std::any_of(paths.begin(), paths.end(),
                     [&](const fs::path& path) { return path.stem() == name; });
}

std::vector<std::string> all_names(const catalog::Catalog& known) {
  std::vector<std::string> names;
  for (const catalog::CatalogEntry& entry : known.entries) names.push_back(entry.name);
  for (const fs::path& path : simulation::list_scenarios()) names.push_back(path.stem().string());
  return names;
}

}  // namespace

Result<void> check_one_meaning(const std::string& name_or_path, const catalog::Catalog& known) {
  const std::string name =
      is_graph_of(name_or_path) ? name_or_path : simulation::without_member(name_or_path);
  const catalog::CatalogEntry* entry = known.find(name);
  if (entry == nullptr || (!is_scenario_name(name) && !is_graph_of(name))) return {};
  return fail(ErrorCode::kInvalid,
              fmt::format("'{}' is a {} and a data set", name,
                          is_graph_of(name) ? "graph of a system" : "scenario"),
              fmt::format("{}:{}", entry->catalog_file.string(), entry->line),
              "names that mean one thing: rename either");
}

Result<DataKind> kind_of_data(const std::string& name_or_path, const catalog::Catalog& known) {
  if (const Result<void> clear = check_one_meaning(name_or_path, known); !clear) {
    return tl::make_unexpected(clear.error());
  }
  if (is_graph_of(name_or_path)) {
    const Result<GraphOf> graph = graph_of_from(name_or_path, known);
    if (!graph) return tl::make_unexpected(graph.error());
    return DataKind::kGraph;
  }
  const std::string name = simulation::without_member(name_or_path);
  if (fs::path(name).extension() == ".toml" || is_scenario_name(name)) return DataKind::kSimulated;
  if (catalog::is_graph_name(name_or_path, known)) return DataKind::kGraph;
  std::error_code ignored;
  if (known.find(name_or_path) != nullptr || fs::exists(name_or_path, ignored)) {
    return DataKind::kRecorded;
  }
  return fail(ErrorCode::kNotFound,
              fmt::format("'{}' is neither a data set nor a scenario nor a file", name_or_path), "",
              fmt::format("one of `list datasets` or `list scenarios`; the nearest names: {}",
                          fmt::join(nearest_names(name, all_names(known)), ", ")));
}

}  // namespace corridor::runner
