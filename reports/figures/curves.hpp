// Curves over two axes with a legend: what the figures about pose graphs have in common.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "reports/figures/scale.hpp"
#include "reports/figures/svg.hpp"

namespace corridor::figures {

struct Curve {
  std::string label;
  const SeriesStyle* style = nullptr;
  std::vector<Eigen::Vector2d> points;         // of the line, by ascending x
  std::vector<Eigen::Vector2d> marks;          // alone, beside the line
  std::vector<Eigen::Vector3d> whiskers = {};  // x, and y from and to: an interval of a mark
};

struct Axis {
  std::string title;
  double low = 0, high = 0;  // low < high; of a logarithmic axis 0 < low
  bool is_logarithmic = true;
  int num_linear_ticks = 5;      // about
  std::vector<Tick> ticks = {};  // if any, instead of round numbers
};

// Where the axes stand.
struct PlotArea {
  double x_px = 0, y_px = 0, width_px = 0, height_px = 0;
};

// The smallest axis with all x (0) or y (1) above zero of lines, marks and whiskers, with a margin;
// low = high = 0 where there is none.
Axis log_axis(std::string title, const std::vector<Curve>& curves, int coordinate);

// What lies outside of the axes is drawn at their ends.
void draw_curves(Svg& svg, const PlotArea& area, const Axis& x, const Axis& y,
                 const std::vector<Curve>& curves);

inline constexpr double kLegendRow_px = 20;
// One row per curve, downwards from y_px.
void draw_legend(Svg& svg, double x_px, double y_px, const std::vector<Curve>& curves);

}  // namespace corridor::figures
