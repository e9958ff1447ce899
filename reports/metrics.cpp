#include "reports/metrics.hpp"

#include <fmt/format.h>

#include <cmath>

namespace corridor::reports {
namespace {

using results::KeyDistance;
using results::KeyDistances;
using results::RunResult;

// One of the four with its unit left to the caller.
struct KeyValue {
  std::optional<double> true_value, measured;
};

KeyValue distance_value(const KeyDistance& distance) {
  return {distance.true_m, distance.measured_m};
}

KeyValue key_value(const RunResult& result, KeyVariable variable, MapKind kind) {
  const auto& map = kind == MapKind::kOwn ? result.own_map : result.rendered_map;
  if (!map.key_distances) return {};
  const KeyDistances& all = *map.key_distances;
  switch (variable) {
    case KeyVariable::kA:
      return distance_value(all.a);
    case KeyVariable::kB:
      return distance_value(all.b);
    case KeyVariable::kC:
      return distance_value(all.c);
    case KeyVariable::kAlpha:
      return {all.alpha.true_deg, all.alpha.measured_deg};
  }
  return {};
}

int decimals_of(KeyVariable variable) { return variable == KeyVariable::kAlpha ? 2 : 3; }

Metric key_metric(KeyVariable variable, MapKind kind, const std::string& what,
                  std::optional<double> (*value)(const KeyValue&)) {
  const std::string prefix = kind == MapKind::kOwn ? "" : "rendered_";
  return {fmt::format("{}{}_{}_{}", prefix, name_of(variable), what, unit_of(variable)),
          fmt::format("{} {} on {}", name_of(variable), what,
                      kind == MapKind::kOwn ? "its own map" : "the common mapper's map"),
          unit_of(variable), decimals_of(variable),
          [=](const RunResult& result) { return value(key_value(result, variable, kind)); }};
}

}  // namespace

Metric position_error() {
  return {"position_rmse_m", "position error", "m", 3,
          [](const RunResult& result) { return result.final_scores.position_rmse_m; }};
}

Metric angle_error() {
  return {"angle_rmse_deg", "angle error", "deg", 3,
          [](const RunResult& result) { return result.final_scores.angle_rmse_deg; }};
}

Metric online_position_error() {
  return {"online_position_rmse_m", "online position error", "m", 3,
          [](const RunResult& result) { return result.online_scores.position_rmse_m; }};
}

Metric online_angle_error() {
  return {"online_angle_rmse_deg", "online angle error", "deg", 3,
          [](const RunResult& result) { return result.online_scores.angle_rmse_deg; }};
}

Metric position_bound() {
  return {"bound_position_rmse_m", "bound of the position error", "m", 4,
          [](const RunResult& result) { return result.bound_position_rmse_m; }};
}

Metric angle_bound() {
  return {"bound_angle_rmse_deg", "bound of the angle error", "deg", 3,
          [](const RunResult& result) { return result.bound_angle_rmse_deg; }};
}

Metric nees_last() {
  return {"nees_last", "NEES of the last pose", "1", 2,
          [](const RunResult& result) { return result.nees_last; }};
}

Metric nees_mean() {
  return {"nees_mean", "mean NEES along the run", "1", 2,
          [](const RunResult& result) { return result.nees_mean; }};
}

std::vector<Metric> detection_scores() {
  return {{"slip_precision", "slip, precision", "1", 2,
           [](const RunResult& result) { return result.slip_precision; }},
          {"slip_recall", "slip, recall", "1", 2,
           [](const RunResult& result) { return result.slip_recall; }},
          {"slip_latency_s", "slip, latency", "s", 2,
           [](const RunResult& result) { return result.slip_latency_s; }},
          {"degeneracy_precision", "degeneracy, precision", "1", 2,
           [](const RunResult& result) { return result.degeneracy_precision; }},
          {"degeneracy_recall", "degeneracy, recall", "1", 2,
           [](const RunResult& result) { return result.degeneracy_recall; }}};
}

Metric relation_translation_mean() {
  return {"relations_translation_mean_m", "relation error, translation mean", "m", 3,
          [](const RunResult& r) { return r.final_relations.relations_translation_mean_m; }};
}

Metric relation_translation_std() {
  return {"relations_translation_std_m", "relation error, translation sd", "m", 3,
          [](const RunResult& r) { return r.final_relations.relations_translation_std_m; }};
}

Metric relation_rotation_mean() {
  return {"relations_rotation_mean_deg", "relation error, rotation mean", "deg", 2,
          [](const RunResult& r) { return r.final_relations.relations_rotation_mean_deg; }};
}

Metric relation_rotation_std() {
  return {"relations_rotation_std_deg", "relation error, rotation sd", "deg", 2,
          [](const RunResult& r) { return r.final_relations.relations_rotation_std_deg; }};
}

Metric online_relation_translation_mean() {
  return {"online_relations_translation_mean_m", "online relation error, translation mean", "m", 3,
          [](const RunResult& r) { return r.online_relations.relations_translation_mean_m; }};
}

Metric map_chamfer() {
  return {"map_chamfer_m", "map distance (Chamfer)", "m", 3,
          [](const RunResult& result) { return result.own_map.map_chamfer_m; }};
}

Metric realtime_factor() {
  Metric metric = {"realtime_factor", "times real time", "1", 1,
                   [](const RunResult& result) { return result.realtime_factor; }};
  metric.digits_max = 3;
  return metric;
}

std::string name_of(KeyVariable variable) {
  switch (variable) {
    case KeyVariable::kA:
      return "a";
    case KeyVariable::kB:
      return "b";
    case KeyVariable::kC:
      return "c";
    case KeyVariable::kAlpha:
      return "alpha";
  }
  return "";
}

std::string unit_of(KeyVariable variable) { return variable == KeyVariable::kAlpha ? "deg" : "m"; }

Metric key_true(KeyVariable variable, MapKind kind) {
  return key_metric(variable, kind, "true", [](const KeyValue& key) { return key.true_value; });
}

Metric key_measured(KeyVariable variable, MapKind kind) {
  return key_metric(variable, kind, "measured", [](const KeyValue& key) { return key.measured; });
}

Metric key_absolute_error(KeyVariable variable, MapKind kind) {
  return key_metric(variable, kind, "absolute_error",
                    [](const KeyValue& key) -> std::optional<double> {
                      if (!key.true_value || !key.measured) return std::nullopt;
                      return std::abs(*key.measured - *key.true_value);
                    });
}

std::vector<Metric> headline_metrics() {
  std::vector<Metric> metrics = {position_error(),        angle_error(),
                                 online_position_error(), relation_translation_mean(),
                                 map_chamfer(),           realtime_factor()};
  for (const KeyVariable variable : kKeyVariables) {
    metrics.push_back(key_measured(variable, MapKind::kOwn));
    metrics.push_back(key_measured(variable, MapKind::kRendered));
  }
  return metrics;
}

}  // namespace corridor::reports
