// Which world and which cases the figures show.
#include "reports/figures/report_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "bench/statistics/quantiles.hpp"
#include "reports/false_closures.hpp"
#include "reports/metrics.hpp"

namespace corridor::figures {
namespace {

using reports::Case;
using reports::Cases;
using reports::Series;
using reports::World;

// Karto is the rival whose failure is the paper's subject; where it was not run, the series whose
// values cover the most worlds stands in.
std::optional<Series> reference_series(const Cases& cases, const std::string& dataset) {
  const auto metric = reports::position_error();
  std::optional<Series> chosen;
  std::size_t most = 0;
  for (const Series& series : cases.series()) {
    const std::size_t num = tables::world_values(cases, dataset, series, metric).size();
    if (num > 0 && series.system == "karto") return series;
    if (num > most) {
      most = num;
      chosen = series;
    }
  }
  return chosen;
}

// What the error of the chosen world is among all: `thing` is a world, or a run on a recorded log.
std::string why_chosen(double chosen_m, const std::vector<double>& all_m, std::string_view thing) {
  if (all_m.size() == 1) return "the only one measured";
  const double median_m = *statistics::median(all_m);
  if (chosen_m == median_m) return fmt::format("the median of its {} {}s", all_m.size(), thing);
  return fmt::format("closest to its median over {} {}s, {:.3f} m", all_m.size(), thing, median_m);
}

}  // namespace

std::optional<Representative> representative_world(const Cases& cases, const std::string& dataset) {
  const auto series = reference_series(cases, dataset);
  if (!series) return std::nullopt;
  const auto values = tables::world_values(cases, dataset, *series, reports::position_error());
  std::vector<double> sorted;
  for (const auto& [world, value] : values) sorted.push_back(value);
  // Of an even number no world has the median: the lower of the two beside it stands in.
  const double middle = *statistics::percentile(sorted, 50);
  const auto found = std::find_if(values.begin(), values.end(),
                                  [&](const auto& item) { return item.second == middle; });
  const World world = found->first;
  const std::string name = world.data_seed
                               ? fmt::format("World {} of {}", *world.data_seed, dataset)
                               : fmt::format("{}, system seed {}", dataset, world.system_seed);
  return Representative{
      world, fmt::format("{}, chosen because {}'s position error there, {:.3f} m, is {}.", name,
                         cases.label(*series), middle,
                         why_chosen(middle, sorted, world.data_seed ? "world" : "run"))};
}

const Case* case_in_world(const Cases& cases, const World& world, const Series& series) {
  for (const Case* entry : cases.of(world.dataset, series)) {
    if (reports::world_of(entry->result) == world) return entry;
  }
  return nullptr;
}

std::vector<Figure> report_figures(const Cases& cases, std::vector<std::string>& problems) {
  std::vector<Figure> figures;
  const auto add = [&](std::optional<Figure> figure) {
    if (figure) figures.push_back(std::move(*figure));
  };
  const Cases logs = cases.of_logs();
  std::set<std::string> families;
  for (const std::string& dataset : logs.datasets()) families.insert(family_of(dataset));
  families.erase("");
  for (const std::string& family : families) add(sweep_figure(logs, family));
  for (const std::string& dataset : logs.datasets()) {
    add(environment_figure(logs, dataset, problems));
    add(trajectory_figure(logs, dataset, problems));
    add(map_figure(logs, dataset, problems));
    add(error_figure(logs, dataset));
    add(stage_figure(logs, dataset));
  }
  const Cases graphs = reports::without_false_closures(cases.of_graphs());
  for (const char* system : {"graph-batch", "graph-incremental"}) {
    add(profile_figure(graphs, system));
  }
  for (const std::string& dataset : graphs.datasets()) {
    add(update_figure(graphs, dataset, problems));
    add(gap_figure(graphs, dataset, problems));
  }
  add(initial_noise_figure(graphs));
  const Cases disturbed = reports::with_false_closures(cases.of_graphs());
  std::set<std::string> backends;
  for (const Series& series : disturbed.series()) backends.insert(series.backend);
  for (const std::string& backend : backends) add(false_closure_figure(disturbed, backend));
  std::sort(problems.begin(), problems.end());
  problems.erase(std::unique(problems.begin(), problems.end()), problems.end());
  return figures;
}

}  // namespace corridor::figures
