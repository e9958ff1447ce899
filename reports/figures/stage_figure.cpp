// Where the time of the steps goes: one bar of shares per system.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "reports/escape.hpp"
#include "reports/figures/report_figures.hpp"
#include "reports/metrics.hpp"
#include "slam/core/stage_clock.hpp"

namespace corridor::figures {
namespace {

using reports::Cases;
using reports::Series;

constexpr double kWidth_px = 960;
constexpr double kLabelWidth_px = 190;
constexpr double kNoteWidth_px = 250;
constexpr double kRow_px = 34;
constexpr double kBar_px = 20;
constexpr double kLegendRow_px = 22;
constexpr double kSwatch_px = 12;

struct Bar {
  std::string label;
  std::array<double, kNumStages> total_s{};
  double sum_s = 0;
  std::string note;
};

std::string note_of(const Cases& cases, const std::string& dataset, const Series& series) {
  const tables::Metric step = {"step_p50_us", "", "us", 0,
                               [](const results::RunResult& r) { return r.step_p50_us; }};
  const auto text = [&](const tables::Metric& metric) -> std::optional<double> {
    const tables::Cell cell = tables::summarise(cases, dataset, series, metric);
    const auto* estimate = std::get_if<tables::Estimate>(&cell);
    return estimate == nullptr ? std::nullopt : std::optional(estimate->median);
  };
  std::string note;
  if (const auto us = text(step)) note = fmt::format("step {:.3g} ms", *us / 1000);
  if (const auto factor = text(reports::realtime_factor())) {
    note += fmt::format("{}{:.3g} × real time", note.empty() ? "" : ", ", *factor);
  }
  return note;
}

std::vector<Bar> load_bars(const Cases& cases, const std::string& dataset) {
  std::vector<Bar> bars;
  for (const Series& series : cases.series()) {
    Bar bar{cases.label(series), {}, 0, note_of(cases, dataset, series)};
    for (const reports::Case* entry : cases.of(dataset, series)) {
      for (const results::StageTimes& stage : entry->result.stages) {
        const auto found = std::find(kStageNames.begin(), kStageNames.end(), stage.name);
        if (found == kStageNames.end()) continue;
        bar.total_s[static_cast<std::size_t>(found - kStageNames.begin())] += stage.total_s;
        bar.sum_s += stage.total_s;
      }
    }
    if (bar.sum_s > 0) bars.push_back(std::move(bar));
  }
  return bars;
}

// Height of the legend.
double draw_legend(Svg& svg, const std::vector<Bar>& bars) {
  double x_px = kLabelWidth_px;
  double y_px = 10;
  for (std::size_t stage = 0; stage < kNumStages; ++stage) {
    const bool is_used = std::any_of(bars.begin(), bars.end(),
                                     [&](const Bar& bar) { return bar.total_s[stage] > 0; });
    if (!is_used) continue;
    const double width_px = kSwatch_px + 8 + text_width_px(kStageNames[stage]) + 16;
    if (x_px + width_px > kWidth_px) {
      x_px = kLabelWidth_px;
      y_px += kLegendRow_px;
    }
    svg.rect(x_px, y_px, kSwatch_px, kSwatch_px,
             fmt::format("fill-{}", stage_style(kStageNames[stage]).name));
    svg.text(x_px + kSwatch_px + 6, y_px + 11, kStageNames[stage]);
    x_px += width_px;
  }
  return y_px + kLegendRow_px + 6;
}

void draw_bar(Svg& svg, const Bar& bar, double y_px) {
  const double width_px = kWidth_px - kLabelWidth_px - kNoteWidth_px;
  svg.text(kLabelWidth_px - 12, y_px + 15, bar.label, "", Anchor::kEnd);
  double x_px = kLabelWidth_px;
  for (std::size_t stage = 0; stage < kNumStages; ++stage) {
    const double part_px = width_px * bar.total_s[stage] / bar.sum_s;
    if (part_px <= 0) continue;
    svg.rect(x_px, y_px, part_px, kBar_px,
             fmt::format("fill-{}", stage_style(kStageNames[stage]).name));
    x_px += part_px;
  }
  svg.text(kLabelWidth_px + width_px + 12, y_px + 15, bar.note, "small");
}

}  // namespace

std::optional<Figure> stage_figure(const Cases& cases, const std::string& dataset) {
  const std::vector<Bar> bars = load_bars(cases, dataset);
  if (bars.empty()) return std::nullopt;
  Svg measured("", kWidth_px, 0, "", "");
  const double legend_px = draw_legend(measured, bars);
  Svg svg("stages-" + reports::file_name_from(dataset), kWidth_px,
          legend_px + kRow_px * static_cast<double>(bars.size()) + 8,
          fmt::format("Time per stage on {}", dataset),
          "One bar per system: share of each stage in the time of all steps");
  draw_legend(svg, bars);
  double y_px = legend_px;
  for (const Bar& bar : bars) {
    draw_bar(svg, bar, y_px);
    y_px += kRow_px;
  }
  return Figure{
      std::move(svg),
      fmt::format("Share of each stage in the time of step() and finish() on {}, all runs "
                  "together; at the right the median step and the median real-time factor "
                  "(above 1: faster than the robot drove).",
                  dataset)};
}

}  // namespace corridor::figures
