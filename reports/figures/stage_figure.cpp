// Where the time of a step goes: per system its steps, then its stages, on one logarithmic axis.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/statistics/quantiles.hpp"
#include "reports/escape.hpp"
#include "reports/figures/report_figures.hpp"
#include "reports/figures/scale.hpp"
#include "reports/figures/series_styles.hpp"
#include "reports/metrics.hpp"
#include "reports/tables/writers.hpp"
#include "reports/timing.hpp"
#include "slam/core/stage_clock.hpp"

namespace corridor::figures {
namespace {

using reports::Case;
using reports::Cases;
using reports::Series;

constexpr double kWidth_px = 960;
constexpr double kNoteWidth_px = 210;
constexpr double kShareBar_px = 90;
constexpr double kTop_px = 30;
constexpr double kBottom_px = 44;
constexpr double kRow_px = 19;
constexpr double kGroupGap_px = 12;
constexpr double kDotRadius_px = 4.5;
constexpr double kAxisMargin_ratio = 1.5;
constexpr double kMsPerUs = 1e-3;
// Stages that took less of the time are left out.
constexpr double kMinShare_ratio = 0.01;

struct Times {
  double p50_ms = 0, p95_ms = 0, max_ms = 0;
};

struct StageRow {
  std::string_view stage;
  Times times;
  double share_ratio = 0;
  double count = 0;  // steps of a run that entered the stage
};

// One system: its steps as a whole, and the stages that matter, in their order.
struct Group {
  std::string label;
  const SeriesStyle* style = nullptr;
  std::optional<Times> step;
  std::string realtime_text;  // empty if not measured
  std::vector<StageRow> stages;
};

// Medians over runs, but the largest maximum of all.
std::optional<Times> pooled(const std::vector<Times>& runs) {
  if (runs.empty()) return std::nullopt;
  std::vector<double> p50_ms;
  std::vector<double> p95_ms;
  Times all;
  for (const Times& run : runs) {
    p50_ms.push_back(run.p50_ms);
    p95_ms.push_back(run.p95_ms);
    all.max_ms = std::max(all.max_ms, run.max_ms);
  }
  all.p50_ms = *statistics::median(p50_ms);
  all.p95_ms = *statistics::median(p95_ms);
  return all;
}

std::optional<Times> step_times(const std::vector<const Case*>& cases) {
  std::vector<Times> runs;
  for (const Case* entry : cases) {
    const results::RunResult& r = entry->result;
    if (!r.step_p50_us || !r.step_p95_us || !r.step_max_us) continue;
    runs.push_back(
        {*r.step_p50_us * kMsPerUs, *r.step_p95_us * kMsPerUs, *r.step_max_us * kMsPerUs});
  }
  return pooled(runs);
}

double total_time_s(const std::vector<const Case*>& cases) {
  double total_s = 0;
  for (const Case* entry : cases) {
    for (const results::StageTimes& stage : entry->result.stages) total_s += stage.total_s;
  }
  return total_s;
}

std::vector<StageRow> stage_rows(const std::vector<const Case*>& cases) {
  const double all_s = total_time_s(cases);
  std::vector<StageRow> rows;
  for (const std::string_view name : kStageNames) {
    std::vector<Times> runs;
    std::vector<double> counts;
    double total_s = 0;
    for (const Case* entry : cases) {
      for (const results::StageTimes& stage : entry->result.stages) {
        if (stage.name != name || stage.count == 0) continue;
        runs.push_back({stage.p50_us * kMsPerUs, stage.p95_us * kMsPerUs, stage.max_us * kMsPerUs});
        counts.push_back(static_cast<double>(stage.count));
        total_s += stage.total_s;
      }
    }
    const auto times = pooled(runs);
    if (!times || total_s < kMinShare_ratio * all_s) continue;
    rows.push_back({name, *times, total_s / all_s, *statistics::median(counts)});
  }
  return rows;
}

std::vector<Group> load_groups(const Cases& cases, const std::string& dataset) {
  const SeriesStyles styles(cases);
  std::vector<Group> groups;
  for (const Series& series : cases.series()) {
    const std::vector<const Case*> tried = cases.of(dataset, series);
    Group group{cases.label(series), &styles(series), step_times(tried), {}, stage_rows(tried)};
    const tables::Cell factor =
        tables::summarise(cases, dataset, series, reports::realtime_factor());
    if (const auto* estimate = std::get_if<tables::Estimate>(&factor)) {
      group.realtime_text = tables::number_text(estimate->median, estimate->decimals);
    }
    if (group.step || !group.stages.empty()) groups.push_back(std::move(group));
  }
  return groups;
}

// Smallest and largest time with a margin; nothing where no time is above zero.
std::optional<std::pair<double, double>> time_range_ms(const std::vector<Group>& groups) {
  double low_ms = 1e300;
  double high_ms = 0;
  const auto include = [&](const Times& times) {
    for (const double value_ms : {times.p50_ms, times.p95_ms, times.max_ms}) {
      if (value_ms <= 0 || !std::isfinite(value_ms)) continue;
      low_ms = std::min(low_ms, value_ms);
      high_ms = std::max(high_ms, value_ms);
    }
  };
  for (const Group& group : groups) {
    if (group.step) include(*group.step);
    for (const StageRow& row : group.stages) include(row.times);
  }
  if (high_ms == 0) return std::nullopt;
  return std::make_pair(low_ms / kAxisMargin_ratio, high_ms * kAxisMargin_ratio);
}

double height_of(const std::vector<Group>& groups) {
  double height_px = 0;
  for (const Group& group : groups) {
    height_px += kGroupGap_px + kRow_px * static_cast<double>(1 + group.stages.size());
  }
  return height_px;
}

// Dot at p50, thick line to p95, thin line to the maximum with its end marked.
void draw_times(Svg& svg, const Times& times, const LogScale& scale, double y_px,
                const SeriesStyle& style, bool is_step) {
  const double max_px = scale(times.max_ms);
  svg.line(scale(times.p50_ms), y_px, max_px, y_px, "axis");
  svg.line(max_px, y_px - 4, max_px, y_px + 4, "axis");
  svg.line(scale(times.p50_ms), y_px, scale(times.p95_ms), y_px,
           is_step ? "interval" : "interval thin");
  svg.marker(style.marker, scale(times.p50_ms), y_px, is_step ? kDotRadius_px : 3,
             fmt::format("fill-{}", style.name));
}

void draw_group(Svg& svg, const Group& group, const LogScale& scale, double label_px,
                double& y_px) {
  const double note_px = kWidth_px - kNoteWidth_px + 14;
  svg.text(label_px - 12, y_px + 4, elided(group.label, label_px - 20), "strong", Anchor::kEnd);
  if (group.step) draw_times(svg, *group.step, scale, y_px, *group.style, true);
  if (!group.realtime_text.empty()) {
    svg.text(note_px, y_px + 4, group.realtime_text + " × real time", "small");
  }
  for (const StageRow& row : group.stages) {
    y_px += kRow_px;
    svg.text(label_px - 12, y_px + 4, row.stage, "small muted", Anchor::kEnd);
    draw_times(svg, row.times, scale, y_px, *group.style, false);
    svg.rect(note_px, y_px - 5, kShareBar_px * row.share_ratio, 10,
             fmt::format("fill-{}", group.style->name));
    svg.text(note_px + kShareBar_px + 6, y_px + 4,
             fmt::format("{:.0f} %, n = {:.0f}", 100 * row.share_ratio, row.count), "small");
  }
  y_px += kRow_px + kGroupGap_px;
}

void draw_axis(Svg& svg, const LogScale& scale, const std::pair<double, double>& range_ms,
               double left_px, double bottom_px) {
  const double right_px = kWidth_px - kNoteWidth_px;
  for (const Tick& tick : log_ticks(range_ms.first, range_ms.second)) {
    const double x_px = scale(tick.value);
    svg.line(x_px, kTop_px - 8, x_px, bottom_px, "grid");
    svg.text(x_px, bottom_px + 16, tick.label, "small", Anchor::kMiddle);
  }
  svg.line(left_px, bottom_px, right_px, bottom_px, "axis");
  svg.text(0.5 * (left_px + right_px), bottom_px + 36, "time [ms]", "", Anchor::kMiddle);
  svg.text(right_px + 14, kTop_px - 14, "share of all time, steps a run", "small muted");
  svg.text(left_px, kTop_px - 14, "dot: p50; thick: to p95; thin: to the largest", "small muted");
}

}  // namespace

std::optional<Figure> stage_figure(const Cases& cases, const std::string& dataset) {
  const std::vector<Group> groups = load_groups(cases, dataset);
  const auto range_ms = time_range_ms(groups);
  if (!range_ms) return std::nullopt;
  std::vector<std::string> labels;
  labels.reserve(groups.size());
  for (const Group& group : groups) labels.push_back(group.label);
  const double label_px = label_column_px(labels);
  const double bottom_px = kTop_px + height_of(groups);
  Svg svg("stages-" + reports::file_name_from(dataset), kWidth_px, bottom_px + kBottom_px,
          fmt::format("Time per step and stage on {}", dataset),
          "Per system the time of a step and of each stage: median, 95 % quantile and maximum on a "
          "logarithmic axis, with each stage's share of all time");
  const LogScale scale(range_ms->first, range_ms->second, label_px, kWidth_px - kNoteWidth_px);
  draw_axis(svg, scale, *range_ms, label_px, bottom_px);
  double y_px = kTop_px + 0.5 * kGroupGap_px + 0.5 * kRow_px;
  for (const Group& group : groups) draw_group(svg, group, scale, label_px, y_px);
  return Figure{
      std::move(svg),
      fmt::format(
          "Time on {}. Bold: a scan's step; below it the stages, over the steps that entered them "
          "(n a run; below 1 % of the time left out). p50 and p95 are medians over runs, the "
          "largest is that of all runs. A system that works on few chosen scans has a small p50 "
          "and says its cost in p95 and the largest. {}",
          dataset, reports::timing_notes(cases).front())};
}

}  // namespace corridor::figures
