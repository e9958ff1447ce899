#include "reports/tables/paper_world.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "reports/published.hpp"

namespace corridor::tables {
namespace {

using reports::MapKind;

// A world whose true values differ by less from the paper's is the paper's world [m, deg].
constexpr double kSameWorld = 1e-6;

}  // namespace

std::set<double> true_values(const reports::Cases& cases, const std::string& dataset,
                             reports::KeyVariable variable) {
  std::set<double> values;
  for (const reports::Case* entry : cases.of(dataset)) {
    for (const MapKind kind : {MapKind::kOwn, MapKind::kRendered}) {
      if (const auto value = reports::key_true(variable, kind).value(entry->result)) {
        values.insert(*value);
      }
    }
  }
  return values;
}

bool is_paper_world(const reports::Cases& cases, const std::string& dataset) {
  const std::vector<const reports::Case*> all = cases.of(dataset);
  if (std::any_of(all.begin(), all.end(),
                  [](const reports::Case* entry) { return !entry->result.data_seed; })) {
    return false;
  }
  return std::all_of(
      reports::kPaperTable1.begin(), reports::kPaperTable1.end(), [&](const auto& published) {
        const std::set<double> values = true_values(cases, dataset, published.variable);
        return !values.empty() && std::abs(*values.begin() - published.true_value) <= kSameWorld &&
               std::abs(*values.rbegin() - published.true_value) <= kSameWorld;
      });
}

bool is_paper_counterpart(const reports::Cases& cases, const reports::Series& series) {
  std::string first_profile;
  std::set<std::string> hashes;
  for (const reports::Series& other : cases.series()) {
    if (other.system != series.system || !other.overrides.empty()) continue;
    if (hashes.empty()) first_profile = other.profile;
    if (other.profile == first_profile) hashes.insert(other.parameters_hash);
  }
  return series.overrides.empty() && series.profile == first_profile && hashes.size() == 1;
}

bool may_stand_beside_paper(const reports::Cases& cases, std::string_view system) {
  const std::vector<reports::Series> all = cases.series();
  const auto is_system = [&](const reports::Series& series) { return series.system == system; };
  return std::none_of(all.begin(), all.end(), is_system) ||
         std::any_of(all.begin(), all.end(), [&](const reports::Series& series) {
           return is_system(series) && is_paper_counterpart(cases, series);
         });
}

}  // namespace corridor::tables
