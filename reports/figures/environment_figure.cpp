// The corridor with its key distances.
#include <fmt/format.h>

#include <cmath>

#include "reports/escape.hpp"
#include "reports/figures/report_figures.hpp"
#include "reports/figures/scene.hpp"
#include "slam/core/units.hpp"

namespace corridor::figures {
namespace {

using simulation::KeyWalls;
using simulation::Segment;

constexpr double kWidth_px = 760;
constexpr double kHeight_px = 520;
constexpr double kMargin_px = 56;
constexpr double kLabelSpace_px = 100;      // at the right, for the label of a
constexpr double kDimensionOffset_px = 30;  // from the wall to its dimension line
constexpr double kHeadLength_px = 9;
constexpr double kHeadHalfWidth_px = 3.5;
constexpr double kArcRadius_px = 46;
constexpr int kArcSteps = 24;

Eigen::Vector2d right_normal(const Eigen::Vector2d& direction) {
  return {direction.y(), -direction.x()};
}

void draw_head(Svg& svg, const Eigen::Vector2d& tip, const Eigen::Vector2d& direction) {
  const Eigen::Vector2d base = tip - kHeadLength_px * direction;
  const Eigen::Vector2d side = kHeadHalfWidth_px * right_normal(direction);
  svg.path(fmt::format("M{:.2f} {:.2f}L{:.2f} {:.2f}L{:.2f} {:.2f}Z", tip.x(), tip.y(),
                       (base + side).x(), (base + side).y(), (base - side).x(), (base - side).y()),
           "dimension-head");
}

void draw_label(Svg& svg, const Eigen::Vector2d& at, const std::string& label) {
  svg.text(at.x(), at.y(), label, "halo", Anchor::kMiddle);
  svg.text(at.x(), at.y(), label, "", Anchor::kMiddle);
}

// A dimension line with heads at both ends and its label in the middle, `label_offset_px` beside
// it.
void draw_dimension(Svg& svg, const Eigen::Vector2d& a_px, const Eigen::Vector2d& b_px,
                    const Eigen::Vector2d& label_offset_px, const std::string& label) {
  const Eigen::Vector2d direction = (b_px - a_px).normalized();
  svg.line(a_px.x(), a_px.y(), b_px.x(), b_px.y(), "dimension");
  draw_head(svg, b_px, direction);
  draw_head(svg, a_px, -direction);
  draw_label(svg, 0.5 * (a_px + b_px) + label_offset_px, label);
}

// Outside of a wall that runs counter-clockwise around the corridor; pixels have +y down.
void draw_outer_dimension(Svg& svg, const PlaneFrame& frame, const Segment& wall,
                          const Eigen::Vector2d& label_offset_px, const std::string& label) {
  const Eigen::Vector2d outward_m = right_normal((wall.b_m - wall.a_m).normalized());
  const Eigen::Vector2d shift_px(kDimensionOffset_px * outward_m.x(),
                                 -kDimensionOffset_px * outward_m.y());
  const Eigen::Vector2d a_px = frame(wall.a_m) + shift_px;
  const Eigen::Vector2d b_px = frame(wall.b_m) + shift_px;
  for (const Eigen::Vector2d& end_px : {a_px, b_px}) {
    const Eigen::Vector2d foot_px = end_px - 0.8 * shift_px;
    const Eigen::Vector2d top_px = end_px + 0.2 * shift_px;
    svg.line(foot_px.x(), foot_px.y(), top_px.x(), top_px.y(), "axis");
  }
  draw_dimension(svg, a_px, b_px, label_offset_px, label);
}

void draw_angle(Svg& svg, const PlaneFrame& frame, const KeyWalls& walls,
                const std::string& label) {
  const Eigen::Vector2d corner_px = frame(walls.right_outer.a_m);
  const Eigen::Vector2d along = walls.lower_outer.a_m - walls.lower_outer.b_m;
  const Eigen::Vector2d up = walls.right_outer.b_m - walls.right_outer.a_m;
  const double begin_rad = std::atan2(up.y(), up.x());
  const double sweep_rad = wrap_angle(std::atan2(along.y(), along.x()) - begin_rad);
  std::vector<Eigen::Vector2d> arc;
  const auto at = [&](double ratio, double radius_px) {
    const double angle_rad = begin_rad + ratio * sweep_rad;
    return Eigen::Vector2d(corner_px +
                           radius_px * Eigen::Vector2d(std::cos(angle_rad), -std::sin(angle_rad)));
  };
  for (int step = 0; step <= kArcSteps; ++step) {
    arc.push_back(at(static_cast<double>(step) / kArcSteps, kArcRadius_px));
  }
  svg.polyline(arc, "dimension");
  draw_label(svg, at(0.6, 1.3 * kArcRadius_px) - Eigen::Vector2d(0.4 * text_width_px(label), 0),
             label);
}

void draw_width(Svg& svg, const PlaneFrame& frame, const KeyWalls& walls,
                const std::string& label) {
  const Segment& outer = walls.lower_outer;
  const Eigen::Vector2d along_m = (outer.b_m - outer.a_m).normalized();
  const Eigen::Vector2d inward_m = -right_normal(along_m);
  const Eigen::Vector2d foot_m = outer.a_m + 0.35 * outer.length_m() * along_m;
  const double width_m = inward_m.dot(walls.lower_inner.a_m - outer.a_m);
  draw_dimension(svg, frame(foot_m), frame(foot_m + width_m * inward_m),
                 {0.6 * text_width_px(label), -24}, label);
}

const reports::Case* case_with_corridor(const reports::Cases& cases, const std::string& dataset,
                                        Scene& scene, std::vector<std::string>& problems) {
  const auto representative = representative_world(cases, dataset);
  for (const reports::Case* entry : cases.of(dataset)) {
    if (representative && reports::world_of(entry->result) != representative->world) continue;
    scene = load_scene(*entry, problems);
    if (scene.world && scene.world->corridor) return entry;
  }
  return nullptr;
}

}  // namespace

std::optional<Figure> environment_figure(const reports::Cases& cases, const std::string& dataset,
                                         std::vector<std::string>& problems) {
  Scene scene;
  const reports::Case* entry = case_with_corridor(cases, dataset, scene, problems);
  if (entry == nullptr) return std::nullopt;
  const simulation::CorridorShape& shape = *scene.world->corridor;
  const KeyWalls walls = simulation::key_walls(shape);
  const std::string labels[] = {fmt::format("a = {:.3f} m", shape.a_m),
                                fmt::format("b = {:.3f} m", shape.b_m),
                                fmt::format("c = {:.3f} m", shape.c_m),
                                fmt::format("α = {:.2f}°", shape.alpha_rad * kDegPerRad)};
  Svg svg("environment-" + reports::file_name_from(dataset), kWidth_px, kHeight_px,
          fmt::format("The corridor of {} with its key distances", dataset),
          fmt::format("Drawing of an L-shaped corridor with {}, {}, {}, {}", labels[0], labels[1],
                      labels[2], labels[3]));
  Bounds bounds;
  include(*scene.world, bounds);
  const PlaneFrame frame(bounds, 0, 0, kWidth_px - kLabelSpace_px, kHeight_px, kMargin_px);
  draw_walls(svg, frame, *scene.world, "wall");
  if (scene.truth) draw_path(svg, frame, positions_m(*scene.truth, Pose2()), "hint");
  draw_outer_dimension(svg, frame, walls.right_outer, {0.55 * text_width_px(labels[0]), 4},
                       labels[0]);
  draw_outer_dimension(svg, frame, walls.lower_outer, {0, 20}, labels[1]);
  draw_width(svg, frame, walls, labels[2]);
  draw_angle(svg, frame, walls, labels[3]);
  return Figure{
      std::move(svg),
      fmt::format("The corridor of {} with its key distances: a and b are the lengths of "
                  "the two outer walls, c the width, α the angle between the outer walls. "
                  "The dotted line is the true path of one world.",
                  dataset)};
}

}  // namespace corridor::figures
