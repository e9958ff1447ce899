// Every system's final trajectory in one frame.
#include <fmt/format.h>

#include "reports/escape.hpp"
#include "reports/figures/report_figures.hpp"
#include "reports/figures/scene.hpp"
#include "reports/figures/series_styles.hpp"
#include "reports/metrics.hpp"

namespace corridor::figures {
namespace {

constexpr double kWidth_px = 960;
constexpr double kHeight_px = 520;
constexpr double kLegendWidth_px = 270;
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

void draw_legend(Svg& svg, const World& world) {
  const double x_px = kWidth_px - kLegendWidth_px + 16;
  double y_px = 40;
  const auto entry = [&](const SeriesStyle& style, const std::string& label) {
    svg.line(x_px, y_px, x_px + 34, y_px, fmt::format("path line-{}", style.name));
    svg.text(x_px + 44, y_px + 4, elided(label, kLegendWidth_px - 62));
    y_px += kLegendLine_px;
  };
  entry(truth_style(), "truth");
  for (const Drawn& drawn : world.estimates) {
    entry(*drawn.style,
          drawn.error_m ? fmt::format("{:.3f} m  {}", *drawn.error_m, drawn.label) : drawn.label);
  }
}

}  // namespace

std::optional<Figure> trajectory_figure(const reports::Cases& cases, const std::string& dataset,
                                        std::vector<std::string>& problems) {
  const auto representative = representative_world(cases, dataset);
  if (!representative) return std::nullopt;
  const World world = load_world(cases, representative->world, problems);
  if (world.estimates.empty()) return std::nullopt;
  Svg svg("trajectories-" + reports::file_name_from(dataset), kWidth_px, kHeight_px,
          fmt::format("Trajectories on {}", dataset),
          fmt::format("Final trajectories of {} systems and the true path. {}",
                      world.estimates.size(), representative->reason));
  const double plot_width_px = kWidth_px - kLegendWidth_px;
  const PlaneFrame frame(frame_bounds(world), 0, 0, plot_width_px, kHeight_px, kMargin_px);
  svg.begin_clip(0, 0, plot_width_px, kHeight_px);
  if (world.walls) draw_walls(svg, frame, *world.walls, "wall");
  draw_path(svg, frame, world.truth_m, "path line-truth");
  for (const Drawn& drawn : world.estimates) {
    draw_path(svg, frame, drawn.points_m, fmt::format("path line-{}", drawn.style->name));
  }
  draw_scale_bar(svg, frame, kMargin_px, kHeight_px - 16, plot_width_px);
  svg.end_group();
  draw_legend(svg, world);
  return Figure{std::move(svg), fmt::format("Final trajectories against the truth, first poses "
                                            "aligned, with each one's position error. {}",
                                            representative->reason)};
}

}  // namespace corridor::figures
