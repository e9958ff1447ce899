#include "reports/tables/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bench/statistics/bootstrap.hpp"
#include "bench/statistics/paired_ratio.hpp"
#include "bench/statistics/quantiles.hpp"
#include "reports/graph_cases.hpp"

namespace corridor::tables {
namespace {

using reports::Case;
using reports::Cases;
using reports::Series;
using reports::World;
using results::CaseStatus;

std::vector<double> values_of(const WorldValues& world_values_by_key) {
  std::vector<double> values;
  for (const auto& [world, value] : world_values_by_key) values.push_back(value);
  return values;
}

// Whether worlds or seeds draw anything that cases could differ by.
bool is_random(const Cases& cases, const std::string& dataset, const Series& series) {
  const std::vector<const Case*> tried = cases.of(dataset, series);
  return std::any_of(tried.begin(), tried.end(), [](const Case* entry) {
    return entry->result.data_seed.has_value() || reports::is_drawn(entry->result);
  });
}

// Requires a value.
Estimate estimate_of(const std::vector<double>& values, int of, const Metric& metric,
                     bool may_have_interval) {
  Estimate estimate;
  estimate.median = *statistics::median(values);
  estimate.n = static_cast<int>(values.size());
  estimate.of = of;
  estimate.decimals = decimals_for(metric, estimate.median);
  if (estimate.n >= kMinValuesForInterval && may_have_interval) {
    if (const auto interval = statistics::bootstrap_median(values)) {
      estimate.low = interval->low;
      estimate.high = interval->high;
    }
  }
  return estimate;
}

bool is_clearly_smaller(const WorldValues& candidate, const WorldValues& rival) {
  if (rival.empty()) return true;  // failed everywhere: nothing to be smaller than
  if (candidate.size() < rival.size()) return false;
  const auto ratio = compare_worlds(rival, candidate);
  return ratio && ratio->high < 1;
}

}  // namespace

WorldValues world_values(const Cases& cases, const std::string& dataset, const Series& series,
                         const Metric& metric) {
  std::map<World, std::vector<double>> by_world;
  for (const Case* entry : cases.of(dataset, series)) {
    const std::optional<double> value = metric.value(entry->result);
    const bool is_usable = entry->result.status != CaseStatus::kPartial;
    if (is_usable && value && std::isfinite(*value)) {
      by_world[reports::world_of(entry->result)].push_back(*value);
    }
  }
  WorldValues values;
  for (const auto& [world, samples] : by_world) values[world] = *statistics::median(samples);
  return values;
}

int num_worlds(const Cases& cases, const std::string& dataset, const Series& series) {
  std::set<World> worlds;
  for (const Case* entry : cases.of(dataset, series)) {
    worlds.insert(reports::world_of(entry->result));
  }
  return static_cast<int>(worlds.size());
}

int num_ok_worlds(const Cases& cases, const std::string& dataset, const Series& series) {
  std::map<World, bool> is_ok;
  for (const Case* entry : cases.of(dataset, series)) {
    const auto [place, is_new] = is_ok.emplace(reports::world_of(entry->result), true);
    place->second = place->second && entry->result.status == CaseStatus::kOk;
  }
  return static_cast<int>(
      std::count_if(is_ok.begin(), is_ok.end(), [](const auto& item) { return item.second; }));
}

bool is_scored(const Cases& cases, const std::string& dataset) {
  const std::vector<const Case*> all = cases.of(dataset);
  return std::any_of(all.begin(), all.end(), [](const Case* entry) {
    const results::RunResult& r = entry->result;
    return r.final_scores.position_rmse_m || r.online_scores.position_rmse_m ||
           r.final_relations.relations_translation_mean_m ||
           r.online_relations.relations_translation_mean_m || r.chi2_best;
  });
}

bool is_simulated(const Cases& cases, const std::string& dataset) {
  const std::vector<const Case*> all = cases.of(dataset);
  return std::any_of(all.begin(), all.end(),
                     [](const Case* entry) { return entry->result.data_seed.has_value(); });
}

int decimals_for(const Metric& metric, double value) {
  int decimals = metric.decimals;
  if (value == 0 || !std::isfinite(value)) return decimals;
  const int magnitude = static_cast<int>(std::floor(std::log10(std::abs(value))));
  if (metric.digits_min > 0) decimals = std::max(decimals, metric.digits_min - 1 - magnitude);
  if (metric.digits_max > 0) decimals = std::min(decimals, metric.digits_max - 1 - magnitude);
  return decimals;
}

Cell summarise_worlds(const Cases& cases, const std::string& dataset, const Metric& metric) {
  WorldValues by_world;
  std::set<World> worlds;
  for (const Case* entry : cases.of(dataset)) {
    const World world = reports::world_of(entry->result);
    worlds.insert(world);
    if (const auto value = metric.value(entry->result)) by_world[world] = *value;
  }
  if (by_world.empty()) return Missing{"not computed"};
  return estimate_of(values_of(by_world), static_cast<int>(worlds.size()), metric, true);
}

Cell summarise(const Cases& cases, const std::string& dataset, const Series& series,
               const Metric& metric, const std::string& reason) {
  const int of = num_worlds(cases, dataset, series);
  if (of == 0) return Missing{"not run"};
  const std::vector<double> values = values_of(world_values(cases, dataset, series, metric));
  if (values.empty()) return Missing{fmt::format("{} (0/{})", reason, of)};
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const bool is_one_run = *least == *most && !is_random(cases, dataset, series);
  return estimate_of(values, of, metric, !is_one_run);
}

std::optional<double> worst(const WorldValues& values) {
  const std::vector<double> all = values_of(values);
  return statistics::percentile(all, 100);
}

std::optional<statistics::Estimate> compare_worlds(const WorldValues& baseline,
                                                   const WorldValues& candidate) {
  std::vector<double> baseline_values;
  std::vector<double> candidate_values;
  for (const auto& [world, value] : baseline) {
    const auto found = candidate.find(world);
    if (found == candidate.end() || value <= 0 || found->second <= 0) continue;
    baseline_values.push_back(value);
    candidate_values.push_back(found->second);
  }
  if (static_cast<int>(baseline_values.size()) < kMinValuesForInterval) return std::nullopt;
  return statistics::paired_ratio(baseline_values, candidate_values);
}

std::optional<std::size_t> clearly_smallest(const std::vector<WorldValues>& values) {
  const auto num_with_values = std::count_if(values.begin(), values.end(),
                                             [](const WorldValues& one) { return !one.empty(); });
  if (num_with_values < 2) return std::nullopt;
  for (std::size_t index = 0; index < values.size(); ++index) {
    if (values[index].empty()) continue;
    bool is_best = true;
    for (std::size_t other = 0; other < values.size() && is_best; ++other) {
      is_best = other == index || is_clearly_smaller(values[index], values[other]);
    }
    if (is_best) return index;
  }
  return std::nullopt;
}

}  // namespace corridor::tables
