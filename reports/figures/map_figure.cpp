// Maps side by side.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "reports/escape.hpp"
#include "reports/figures/report_figures.hpp"
#include "reports/figures/scene.hpp"
#include "reports/metrics.hpp"

namespace corridor::figures {
namespace {

using reports::Case;
using reports::Cases;
using reports::Series;

constexpr double kWidth_px = 960;
constexpr double kGap_px = 12;
constexpr double kHeading_px = 26;
constexpr double kPanelMargin_px = 26;     // leaves room for the scale bar
constexpr double kMinAspect_ratio = 0.55;  // height / width of a panel
constexpr double kMaxAspect_ratio = 1.1;
// How far beyond the true walls a map is shown.
constexpr double kMaxGrowth_ratio = 0.25;
// Free space around a map without known walls.
constexpr double kMapSpace_ratio = 0.06;
constexpr std::array<std::string_view, 4> kPaperSystems = {"gmapping", "karto", "fusion-paper",
                                                           "fusion"};

struct Panel {
  std::string system;
  std::string label;    // shortened where it does not fit
  std::string outcome;  // never shortened: "*: 0.021 m, diverged"
  Scene scene;
};

bool has_walls(const std::vector<Panel>& panels) {
  return std::any_of(panels.begin(), panels.end(),
                     [](const Panel& panel) { return panel.scene.world.has_value(); });
}

// In simulated worlds those that the paper compares; of a recording whatever ran.
void keep_shown(std::vector<Panel>& panels) {
  if (!has_walls(panels)) return;
  std::erase_if(panels, [](const Panel& panel) {
    return std::find(kPaperSystems.begin(), kPaperSystems.end(), panel.system) ==
           kPaperSystems.end();
  });
}

// Three panels share a row: the caption says what the length and the star mean.
std::string outcome_of(const Case& entry, const Scene& scene) {
  std::string outcome = scene.is_map_rendered ? "*" : "";
  const auto error_m = reports::position_error().value(entry.result);
  const auto relation_m = reports::relation_translation_mean().value(entry.result);
  if (error_m || relation_m) outcome += fmt::format(": {:.3f} m", error_m ? *error_m : *relation_m);
  if (entry.result.status != results::CaseStatus::kOk) {
    outcome += ", " + results::to_text(entry.result.status);
  }
  return outcome;
}

std::vector<Panel> load_panels(const Cases& cases, const std::string& dataset,
                               const std::optional<Representative>& representative,
                               std::vector<std::string>& problems) {
  std::vector<Panel> panels;
  for (const Series& series : cases.series()) {
    const std::vector<const Case*> all = cases.of(dataset, series);
    const Case* entry = representative ? case_in_world(cases, representative->world, series)
                        : all.empty()  ? nullptr
                                       : all.front();
    if (entry == nullptr) continue;
    Scene scene = load_scene(*entry, problems);
    const std::string outcome = outcome_of(*entry, scene);
    panels.push_back({series.system, cases.label(series), outcome, std::move(scene)});
  }
  keep_shown(panels);
  return panels;
}

// The walls of one panel and its map, which may reach beyond them by a part of their size; the map
// alone, with some space around, where no walls are known.
Bounds panel_bounds(const Panel& panel) {
  Bounds bounds;
  if (panel.scene.world) {
    include(*panel.scene.world, bounds);
  }
  if (!panel.scene.map) return bounds;
  const Bounds map = occupied_bounds(*panel.scene.map, panel.scene.T_world_map);
  if (map.is_empty()) return bounds;
  if (bounds.is_empty()) {
    const Eigen::Vector2d space_m =
        Eigen::Vector2d::Constant(kMapSpace_ratio * map.size_m().maxCoeff());
    return {map.min_m - space_m, map.max_m + space_m};
  }
  const Eigen::Vector2d growth_m =
      Eigen::Vector2d::Constant(kMaxGrowth_ratio * bounds.size_m().maxCoeff());
  return {bounds.min_m.cwiseMin(map.min_m.cwiseMax(bounds.min_m - growth_m)),
          bounds.max_m.cwiseMax(map.max_m.cwiseMin(bounds.max_m + growth_m))};
}

// One frame for all panels where walls are known, so that lengths compare by eye.
std::vector<Bounds> all_bounds(const std::vector<Panel>& panels) {
  std::vector<Bounds> bounds;
  Bounds common;
  for (const Panel& panel : panels) {
    bounds.push_back(panel_bounds(panel));
    if (bounds.back().is_empty()) continue;
    common.include(bounds.back().min_m);
    common.include(bounds.back().max_m);
  }
  if (has_walls(panels)) std::fill(bounds.begin(), bounds.end(), common);
  return bounds;
}

double aspect_ratio(const std::vector<Bounds>& bounds) {
  double largest = kMinAspect_ratio;
  for (const Bounds& one : bounds) {
    if (one.is_empty() || one.size_m().x() <= 0) continue;
    largest = std::max(largest, one.size_m().y() / one.size_m().x());
  }
  return std::min(largest, kMaxAspect_ratio);
}

void draw_panel(Svg& svg, const Panel& panel, const Bounds& bounds, double x_px, double y_px,
                double width_px, double height_px) {
  svg.text(x_px + 2, y_px + 17,
           elided(panel.label, width_px - text_width_px(panel.outcome)) + panel.outcome);
  const double top_px = y_px + kHeading_px;
  svg.rect(x_px, top_px, width_px, height_px, "panel");
  const PlaneFrame frame(bounds, x_px, top_px, width_px, height_px, kPanelMargin_px);
  svg.begin_clip(x_px, top_px, width_px, height_px);
  const bool has_map =
      panel.scene.map && draw_map(svg, frame, *panel.scene.map, panel.scene.T_world_map);
  if (panel.scene.world) draw_walls(svg, frame, *panel.scene.world, "wall-over");
  if (has_map) {
    draw_scale_bar(svg, frame, x_px + 12, top_px + height_px - 12, width_px);
  } else {
    svg.text(x_px + 0.5 * width_px, top_px + 0.5 * height_px, "no map", "muted", Anchor::kMiddle);
  }
  svg.end_group();
}

}  // namespace

std::optional<Figure> map_figure(const Cases& cases, const std::string& dataset,
                                 std::vector<std::string>& problems) {
  const auto representative = representative_world(cases, dataset);
  const std::vector<Panel> panels = load_panels(cases, dataset, representative, problems);
  const bool has_any = std::any_of(panels.begin(), panels.end(),
                                   [](const Panel& panel) { return panel.scene.map.has_value(); });
  if (!has_any) return std::nullopt;
  const std::vector<Bounds> bounds = all_bounds(panels);
  const int num_columns = panels.size() <= 4 ? 2 : 3;
  const auto num_rows = (static_cast<int>(panels.size()) + num_columns - 1) / num_columns;
  const double width_px = (kWidth_px - (num_columns + 1) * kGap_px) / num_columns;
  const double height_px = width_px * aspect_ratio(bounds);
  const double row_px = height_px + kHeading_px + kGap_px;
  Svg svg("maps-" + reports::file_name_from(dataset), kWidth_px, num_rows * row_px + kGap_px,
          fmt::format("Maps of {}", dataset),
          fmt::format("Occupancy maps of {} systems side by side", panels.size()));
  for (std::size_t index = 0; index < panels.size(); ++index) {
    const auto column = static_cast<int>(index) % num_columns;
    const auto row = static_cast<int>(index) / num_columns;
    draw_panel(svg, panels[index], bounds[index], kGap_px + column * (width_px + kGap_px),
               row * row_px + 4, width_px, height_px);
  }
  std::string caption = fmt::format(
      "Maps of {}: occupied black, free white, unknown grey. Lengths: position RMSE "
      "(mean relation error on recorded data).",
      dataset);
  if (has_walls(panels)) {
    caption += " Lines: the true walls, first poses aligned; one scale for all.";
  } else if (panels.size() > 1) {
    caption +=
        " Scales differ from panel to panel: each shows its own map whole, with its own bar.";
  }
  if (!tables::is_scored(cases, dataset)) {
    caption += " No truth is known here: whether a map is right, only looking tells.";
  }
  const bool has_rendered = std::any_of(
      panels.begin(), panels.end(), [](const Panel& panel) { return panel.scene.is_map_rendered; });
  if (has_rendered) {
    caption += " *: the system makes no map; the common mapper drew this one from its trajectory.";
  }
  if (representative) caption += " " + representative->reason;
  return Figure{std::move(svg), std::move(caption)};
}

}  // namespace corridor::figures
