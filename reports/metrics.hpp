// The numbers of a RunResult that reports show, by name.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "reports/tables/summary.hpp"

namespace corridor::reports {

using tables::Metric;

// Position and angle error, first poses aligned: the paper's two.
Metric position_error();
Metric angle_error();
Metric online_position_error();
Metric online_angle_error();
// What the log allows, whatever the system.
Metric position_bound();
Metric angle_bound();
Metric nees_last();
Metric nees_mean();
// How well slips and blind directions were noticed.
std::vector<Metric> detection_scores();
Metric relation_translation_mean();
Metric relation_translation_std();
Metric relation_rotation_mean();
Metric relation_rotation_std();
Metric online_relation_translation_mean();
Metric map_chamfer();
Metric realtime_factor();

// Where a key distance was measured.
enum class MapKind {
  kOwn,       // the system's own map
  kRendered,  // one common mapper's map of the system's trajectory
};
enum class KeyVariable { kA, kB, kC, kAlpha };
inline constexpr std::array kKeyVariables = {KeyVariable::kA, KeyVariable::kB, KeyVariable::kC,
                                             KeyVariable::kAlpha};

// "a", "b", "c", "alpha" and "m" or "deg".
std::string name_of(KeyVariable variable);
std::string unit_of(KeyVariable variable);
Metric key_true(KeyVariable variable, MapKind kind);
Metric key_measured(KeyVariable variable, MapKind kind);
// |measured - true|.
Metric key_absolute_error(KeyVariable variable, MapKind kind);

// All whose absence the page reports.
std::vector<Metric> headline_metrics();

}  // namespace corridor::reports
