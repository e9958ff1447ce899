#include "reports/figures/curves.hpp"

#include <algorithm>
#include <cmath>

namespace corridor::figures {
namespace {

constexpr double kMargin_ratio = 1.15;  // of a logarithmic axis, beyond the smallest and largest
constexpr double kMarkRadius_px = 2.5;
constexpr double kLegendLine_px = 30;

double place(const Axis& axis, double value, double begin_px, double end_px) {
  if (axis.is_logarithmic) return LogScale(axis.low, axis.high, begin_px, end_px)(value);
  const double ratio = std::clamp((value - axis.low) / (axis.high - axis.low), 0.0, 1.0);
  return begin_px + ratio * (end_px - begin_px);
}

std::vector<Tick> ticks_of(const Axis& axis) {
  if (!axis.ticks.empty()) return axis.ticks;
  return axis.is_logarithmic ? log_ticks(axis.low, axis.high)
                             : linear_ticks(axis.low, axis.high, axis.num_linear_ticks);
}

void draw_axes(Svg& svg, const PlotArea& area, const Axis& x, const Axis& y) {
  const double right_px = area.x_px + area.width_px;
  const double bottom_px = area.y_px + area.height_px;
  for (const Tick& tick : ticks_of(x)) {
    const double x_px = place(x, tick.value, area.x_px, right_px);
    svg.line(x_px, area.y_px, x_px, bottom_px, "grid");
    svg.text(x_px, bottom_px + 16, tick.label, "small", Anchor::kMiddle);
  }
  for (const Tick& tick : ticks_of(y)) {
    const double y_px = place(y, tick.value, bottom_px, area.y_px);
    svg.line(area.x_px, y_px, right_px, y_px, "grid");
    svg.text(area.x_px - 6, y_px + 4, tick.label, "small", Anchor::kEnd);
  }
  svg.line(area.x_px, bottom_px, right_px, bottom_px, "axis");
  svg.line(area.x_px, area.y_px, area.x_px, bottom_px, "axis");
  svg.text(area.x_px + 0.5 * area.width_px, bottom_px + 36, x.title, "", Anchor::kMiddle);
  svg.text(area.x_px, area.y_px - 10, y.title, "");
}

}  // namespace

Axis log_axis(std::string title, const std::vector<Curve>& curves, int coordinate) {
  double low = HUGE_VAL, high = 0;
  const auto include = [&](double value) {
    if (value <= 0) return;
    low = std::min(low, value);
    high = std::max(high, value);
  };
  for (const Curve& curve : curves) {
    for (const auto* points : {&curve.points, &curve.marks}) {
      for (const Eigen::Vector2d& point : *points) include(point(coordinate));
    }
    for (const Eigen::Vector3d& whisker : curve.whiskers) {
      include(whisker(coordinate));
      if (coordinate == 1) include(whisker.z());
    }
  }
  if (high == 0) return {std::move(title)};
  return {std::move(title), low / kMargin_ratio, high * kMargin_ratio};
}

void draw_curves(Svg& svg, const PlotArea& area, const Axis& x, const Axis& y,
                 const std::vector<Curve>& curves) {
  draw_axes(svg, area, x, y);
  const auto at = [&](const Eigen::Vector2d& point) {
    return Eigen::Vector2d(place(x, point.x(), area.x_px, area.x_px + area.width_px),
                           place(y, point.y(), area.y_px + area.height_px, area.y_px));
  };
  for (const Curve& curve : curves) {
    const std::string name(curve.style->name);
    for (const Eigen::Vector3d& whisker : curve.whiskers) {
      const Eigen::Vector2d from_px = at({whisker.x(), whisker.y()});
      const Eigen::Vector2d to_px = at({whisker.x(), whisker.z()});
      svg.line(from_px.x(), from_px.y(), to_px.x(), to_px.y(), "whisker line-" + name);
    }
    for (const Eigen::Vector2d& mark : curve.marks) {
      const Eigen::Vector2d mark_px = at(mark);
      svg.marker(curve.style->marker, mark_px.x(), mark_px.y(), kMarkRadius_px, "dot fill-" + name);
    }
    std::vector<Eigen::Vector2d> line_px;
    for (const Eigen::Vector2d& point : curve.points) line_px.push_back(at(point));
    if (!line_px.empty()) svg.polyline(line_px, "path line-" + name);
  }
}

void draw_legend(Svg& svg, double x_px, double y_px, const std::vector<Curve>& curves) {
  for (const Curve& curve : curves) {
    const std::string name(curve.style->name);
    svg.polyline({{x_px, y_px}, {x_px + kLegendLine_px, y_px}}, "path line-" + name);
    if (!curve.marks.empty()) {
      svg.marker(curve.style->marker, x_px + 0.5 * kLegendLine_px, y_px, kMarkRadius_px + 1,
                 "fill-" + name);
    }
    svg.text(x_px + kLegendLine_px + 8, y_px + 4, curve.label, "small");
    y_px += kLegendRow_px;
  }
}

}  // namespace corridor::figures
