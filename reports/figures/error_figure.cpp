// Every world's errors per system: dots, median and its interval, on logarithmic axes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/escape.hpp"
#include "reports/figures/report_figures.hpp"
#include "reports/figures/scale.hpp"
#include "reports/figures/series_styles.hpp"
#include "reports/metrics.hpp"
#include "reports/published.hpp"
#include "reports/tables/paper_world.hpp"

namespace corridor::figures {
namespace {

using reports::Cases;
using reports::Series;
using tables::WorldValues;

constexpr double kWidth_px = 960;
constexpr double kGap_px = 34;
constexpr double kRow_px = 40;
constexpr double kTop_px = 38;
constexpr double kBottom_px = 44;
constexpr double kDotRadius_px = 4;
constexpr double kSmallFont_px = 11;
constexpr double kAxisMargin_ratio = 1.3;  // free space beyond the smallest and largest value
// Dots of neighbouring worlds are set apart across the axis, by a fixed pattern.
constexpr int kJitterLevels = 5;
constexpr double kJitter_px = 4;

struct Row {
  const SeriesStyle* style = nullptr;
  std::string label;
  WorldValues values;
  std::optional<tables::Estimate> estimate;
  std::optional<double> published;
};

struct Plot {
  double x_px, width_px, height_px;
  std::optional<double> bound;  // what the data allow, median over worlds
};

std::optional<double> published_error(const std::string& system, bool is_position) {
  for (const reports::PublishedError& published : reports::kPaperTable2) {
    if (published.system == system) {
      return is_position ? published.position_m : published.angle_deg;
    }
  }
  return std::nullopt;
}

std::vector<Row> load_rows(const Cases& cases, const std::string& dataset, bool is_position) {
  const tables::Metric metric = is_position ? reports::position_error() : reports::angle_error();
  const bool is_paper = tables::is_paper_world(cases, dataset);
  const SeriesStyles styles(cases);
  std::vector<Row> rows;
  for (const Series& series : cases.series()) {
    if (cases.of(dataset, series).empty()) continue;
    Row row{&styles(series),
            cases.label(series),
            tables::world_values(cases, dataset, series, metric),
            {},
            is_paper && tables::is_paper_counterpart(cases, series)
                ? published_error(series.system, is_position)
                : std::nullopt};
    const tables::Cell cell = tables::summarise(cases, dataset, series, metric);
    if (const auto* estimate = std::get_if<tables::Estimate>(&cell)) row.estimate = *estimate;
    rows.push_back(std::move(row));
  }
  return rows;
}

std::optional<double> bound_of(const Cases& cases, const std::string& dataset,
                               const tables::Metric& metric) {
  const tables::Cell cell = tables::summarise_worlds(cases, dataset, metric);
  const auto* estimate = std::get_if<tables::Estimate>(&cell);
  return estimate == nullptr ? std::nullopt : std::make_optional(estimate->median);
}

std::optional<std::pair<double, double>> positive_range(const std::vector<Row>& rows,
                                                        std::optional<double> bound) {
  double low = 1e300;
  double high = 0;
  const auto include = [&](double value) {
    if (value <= 0) return;
    low = std::min(low, value);
    high = std::max(high, value);
  };
  for (const Row& row : rows) {
    for (const auto& [world, value] : row.values) include(value);
    if (row.published && !row.values.empty()) include(*row.published);
  }
  if (high == 0) return std::nullopt;
  if (bound) include(*bound);
  return std::make_pair(low / kAxisMargin_ratio, high * kAxisMargin_ratio);
}

void draw_axis(Svg& svg, const Plot& plot, const LogScale& scale, double low, double high,
               const std::string& title) {
  const double bottom_px = kTop_px + plot.height_px;
  double last_label_px = -1e9;
  for (const Tick& tick : log_ticks(low, high)) {
    const double x_px = scale(tick.value);
    svg.line(x_px, kTop_px, x_px, bottom_px, "grid");
    const double half_px = 0.5 * text_width_px(tick.label, kSmallFont_px) + 3;
    if (x_px - half_px < last_label_px) continue;
    svg.text(x_px, bottom_px + 16, tick.label, "small", Anchor::kMiddle);
    last_label_px = x_px + half_px;
  }
  svg.line(plot.x_px, bottom_px, plot.x_px + plot.width_px, bottom_px, "axis");
  svg.text(plot.x_px + 0.5 * plot.width_px, bottom_px + 36, title, "", Anchor::kMiddle);
}

void draw_row(Svg& svg, const Row& row, const LogScale& scale, double y_px) {
  const SeriesStyle& style = *row.style;
  int index = 0;
  for (const auto& [world, value] : row.values) {
    const double offset_px = kJitter_px * (index++ % kJitterLevels - kJitterLevels / 2);
    svg.marker(style.marker, scale(value), y_px + offset_px, kDotRadius_px,
               fmt::format("dot fill-{}", style.name));
  }
  if (!row.estimate) return;
  if (row.estimate->low && row.estimate->high) {
    svg.line(scale(*row.estimate->low), y_px, scale(*row.estimate->high), y_px, "interval");
  }
  const double x_px = scale(row.estimate->median);
  svg.line(x_px, y_px - 12, x_px, y_px + 12, "interval");
  if (row.published) {
    const double paper_px = scale(*row.published);
    svg.line(paper_px - 5, y_px - 5, paper_px + 5, y_px + 5, "axis");
    svg.line(paper_px - 5, y_px + 5, paper_px + 5, y_px - 5, "axis");
  }
}

// What marks and lines mean, for a figure that stands alone.
void draw_legend(Svg& svg, double x_px, bool has_bound, bool has_paper) {
  const double y_px = 14;
  const auto say = [&](const std::string& text) {
    svg.text(x_px + 16, y_px + 4, text, "small");
    x_px += 40 + text_width_px(text, kSmallFont_px);
  };
  svg.marker(Marker::kCircle, x_px + 4, y_px, kDotRadius_px, "muted");
  say("one world");
  svg.line(x_px + 4, y_px - 8, x_px + 4, y_px + 8, "interval");
  say("median");
  svg.line(x_px - 6, y_px, x_px + 10, y_px, "interval");
  say("its 95 % bootstrap interval");
  if (has_bound) {
    svg.line(x_px + 4, y_px - 8, x_px + 4, y_px + 8, "limit");
    say("Cramer-Rao bound");
  }
  if (!has_paper) return;
  svg.line(x_px - 1, y_px - 5, x_px + 9, y_px + 5, "axis");
  svg.line(x_px - 1, y_px + 5, x_px + 9, y_px - 5, "axis");
  say("the paper");
}

void draw_plot(Svg& svg, const Plot& plot, const std::vector<Row>& rows, const std::string& title) {
  const auto range = positive_range(rows, plot.bound);
  if (!range) {
    svg.text(plot.x_px + 0.5 * plot.width_px, kTop_px + 0.5 * plot.height_px, "not measured",
             "muted", Anchor::kMiddle);
    return;
  }
  const LogScale scale(range->first, range->second, plot.x_px, plot.x_px + plot.width_px);
  draw_axis(svg, plot, scale, range->first, range->second, title);
  if (plot.bound) {
    const double x_px = scale(*plot.bound);
    svg.line(x_px, kTop_px, x_px, kTop_px + plot.height_px, "limit");
  }
  double y_px = kTop_px + 0.5 * kRow_px;
  for (const Row& row : rows) {
    draw_row(svg, row, scale, y_px);
    y_px += kRow_px;
  }
}

}  // namespace

std::optional<Figure> error_figure(const Cases& cases, const std::string& dataset) {
  const std::vector<Row> position = load_rows(cases, dataset, true);
  const std::vector<Row> angle = load_rows(cases, dataset, false);
  if (!positive_range(position, {})) return std::nullopt;
  const auto position_bound = bound_of(cases, dataset, reports::position_bound());
  const auto angle_bound = bound_of(cases, dataset, reports::angle_bound());
  const double height_px = kRow_px * static_cast<double>(position.size());
  std::vector<std::string> labels;
  labels.reserve(position.size());
  for (const Row& row : position) labels.push_back(row.label);
  const double label_px = label_column_px(labels);
  const double width_px = (kWidth_px - label_px - 2 * kGap_px) / 2;
  Svg svg("errors-" + reports::file_name_from(dataset), kWidth_px, kTop_px + height_px + kBottom_px,
          fmt::format("Position and angle errors on {}", dataset),
          "One dot per world and system on logarithmic axes, with median and interval");
  double y_px = kTop_px + 0.5 * kRow_px;
  for (const Row& row : position) {
    svg.text(label_px - 12, y_px + 4, elided(row.label, label_px - 20), "", Anchor::kEnd);
    y_px += kRow_px;
  }
  draw_legend(svg, label_px, position_bound.has_value(), tables::is_paper_world(cases, dataset));
  draw_plot(svg, {label_px, width_px, height_px, position_bound}, position, "position error [m]");
  draw_plot(svg, {label_px + width_px + kGap_px, width_px, height_px, angle_bound}, angle,
            "angle error [deg]");
  return Figure{
      std::move(svg),
      fmt::format("Position and angle error on {} (RMSE of the final trajectory, first "
                  "poses aligned), logarithmic axes. One mark per world; upright line: "
                  "median; bar: its 95 % bootstrap interval{}{}.",
                  dataset,
                  position_bound ? "; dashed line: the median over the worlds of the Cramer-Rao "
                                   "bound, below which no unbiased estimator falls on average"
                                 : "",
                  tables::is_paper_world(cases, dataset) ? "; cross: the paper's value" : "")};
}

}  // namespace corridor::figures
