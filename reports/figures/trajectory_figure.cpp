// Every system's final trajectory in one frame.
#include <fmt/format.h>

#include <algorithm>

#include "reports/escape.hpp"
#include "reports/figures/report_figures.hpp"
#include "reports/figures/scene.hpp"
#include "reports/figures/series_styles.hpp"
#include "reports/metrics.hpp"

namespace corridor::figures {
namespace {

constexpr double kPlotWidth_px = 690;
constexpr double kHeight_px = 520;
constexpr double kLegendGap_px = 16;
constexpr double kLegendText_px = 44;  // from the line to its text
constexpr double kMinLegendText_px = 210;
constexpr double kMaxLegendText_px = 420;
constexpr double kMargin_px = 24;
constexpr double kLegendLine_px = 24;
// A trajectory that runs away is cut here, so that the others stay legible.
constexpr double kMaxGrowth_ratio = 0.35;

struct Drawn {
  std::string label;
  const SeriesStyle* style = nullptr;
  std::vector<Eigen::Vector2d> points_m;
  std::optional<double> error_m;
};

struct World {
  std::vector<Drawn> estimates;
  std::vector<Eigen::Vector2d> truth_m;
  std::optional<simulation::World> walls;
};

World load_world(const reports::Cases& cases, const reports::World& world,
                 std::vector<std::string>& problems) {
  World loaded;
  const SeriesStyles styles(cases);
  for (const reports::Series& series : cases.series()) {
    const reports::Case* entry = case_in_world(cases, world, series);
    if (entry == nullptr) continue;
    const Scene scene = load_scene(*entry, problems);
    if (!scene.truth || !scene.estimate) continue;
    loaded.truth_m = positions_m(*scene.truth, Pose2());
    if (scene.world) loaded.walls = scene.world;
    loaded.estimates.push_back({cases.label(series), &styles(series),
                                positions_m(*scene.estimate, scene.T_world_map),
                                reports::position_error().value(entry->result)});
  }
  return loaded;
}

Bounds frame_bounds(const World& world) {
  Bounds core;
  for (const Eigen::Vector2d& point_m : world.truth_m) core.include(point_m);
  if (world.walls) {
    include(*world.walls, core);
  }
  const Eigen::Vector2d growth_m =
      Eigen::Vector2d::Constant(kMaxGrowth_ratio * core.size_m().maxCoeff());
  Bounds bounds = core;
  for (const Drawn& drawn : world.estimates) {
    for (const Eigen::Vector2d& point_m : drawn.points_m) {
      bounds.include(point_m.cwiseMax(core.min_m - growth_m).cwiseMin(core.max_m + growth_m));
    }
  }
  return bounds;
}

struct LegendEntry {
  const SeriesStyle* style = nullptr;
  std::string text;
};

std::vector<LegendEntry> legend_of(const World& world) {
  std::vector<LegendEntry> entries = {{&truth_style(), "truth"}};
  for (const Drawn& drawn : world.estimates) {
    entries.push_back({drawn.style, drawn.error_m
                                        ? fmt::format("{}: {:.3f} m", drawn.label, *drawn.error_m)
                                        : drawn.label});
  }
  return entries;
}

double legend_text_px(const std::vector<LegendEntry>& legend) {
  double widest_px = kMinLegendText_px;
  for (const LegendEntry& entry : legend)
    widest_px = std::max(widest_px, text_width_px(entry.text));
  return std::min(widest_px, kMaxLegendText_px);
}

void draw_legend(Svg& svg, const std::vector<LegendEntry>& legend) {
  const double x_px = kPlotWidth_px + kLegendGap_px;
  double y_px = 40;
  for (const LegendEntry& entry : legend) {
    svg.line(x_px, y_px, x_px + 34, y_px, fmt::format("path line-{}", entry.style->name));
    svg.text(x_px + kLegendText_px, y_px + 4, elided(entry.text, legend_text_px(legend)));
    y_px += kLegendLine_px;
  }
}

}  // namespace

std::optional<Figure> trajectory_figure(const reports::Cases& cases, const std::string& dataset,
                                        std::vector<std::string>& problems) {
  const auto representative = representative_world(cases, dataset);
  if (!representative) return std::nullopt;
  const World world = load_world(cases, representative->world, problems);
  if (world.estimates.empty()) return std::nullopt;
  const std::vector<LegendEntry> legend = legend_of(world);
  const double height_px =
      std::max(kHeight_px, kLegendLine_px * static_cast<double>(legend.size() + 2));
  Svg svg("trajectories-" + reports::file_name_from(dataset),
          kPlotWidth_px + kLegendGap_px + kLegendText_px + legend_text_px(legend), height_px,
          fmt::format("Trajectories on {}", dataset),
          fmt::format("Final trajectories of {} systems and the true path. {}",
                      world.estimates.size(), representative->reason));
  const PlaneFrame frame(frame_bounds(world), 0, 0, kPlotWidth_px, height_px, kMargin_px);
  svg.begin_clip(0, 0, kPlotWidth_px, height_px);
  if (world.walls) draw_walls(svg, frame, *world.walls, "wall");
  draw_path(svg, frame, world.truth_m, "path line-truth");
  for (const Drawn& drawn : world.estimates) {
    draw_path(svg, frame, drawn.points_m, fmt::format("path line-{}", drawn.style->name));
  }
  draw_scale_bar(svg, frame, kMargin_px, height_px - 16, kPlotWidth_px);
  svg.end_group();
  draw_legend(svg, legend);
  return Figure{std::move(svg), fmt::format("Final trajectories against the truth, first poses "
                                            "aligned, with each one's position error. {}",
                                            representative->reason)};
}

}  // namespace corridor::figures
