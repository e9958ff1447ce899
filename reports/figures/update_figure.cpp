// Time of an update over the number of poses so far, with the exponent by which it grows.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/statistics/quantiles.hpp"
#include "reports/escape.hpp"
#include "reports/figures/curves.hpp"
#include "reports/figures/report_figures.hpp"
#include "reports/graph_cases.hpp"
#include "reports/timing.hpp"

namespace corridor::figures {
namespace {

using reports::Case;
using reports::Cases;
using reports::Series;

constexpr double kWidth_px = 720;
constexpr double kPlotHeight_px = 340;
constexpr double kLeft_px = 84;
constexpr double kTop_px = 40;
constexpr double kBottom_px = 50;
constexpr double kRight_px = 24;
constexpr double kMilliseconds = 1e3;
// Updates of nearly the same number of poses are one point: so many to a factor of ten.
constexpr double kBinsPerDecade = 12;
// Growth is that of large graphs: over the updates with at least a tenth of all poses.
constexpr double kFitFrom_ratio = 0.1;

// Per number of poses the smallest time of all repeats: what disturbs a machine only adds.
std::map<double, double> undisturbed_s(const std::vector<const Case*>& cases,
                                       std::vector<std::string>& problems) {
  std::map<double, double> smallest_s;
  for (const Case* entry : cases) {
    if (!reports::is_pose_by_pose(entry->result)) continue;
    const auto rows = reports::read_updates(entry->dir);
    if (!rows) {
      problems.push_back(rows.error().to_line());
      continue;
    }
    for (const reports::UpdateRow& row : *rows) {
      const auto [place, is_new] = smallest_s.emplace(row.num_poses, row.time_s);
      place->second = std::min(place->second, row.time_s);
    }
  }
  return smallest_s;
}

// Slope of ln time over ln poses by least squares; nullopt with fewer than two numbers of poses.
std::optional<double> growth(const std::map<double, double>& times_s) {
  double n = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (const auto& [poses, time_s] : times_s) {
    if (poses < kFitFrom_ratio * times_s.rbegin()->first || time_s <= 0) continue;
    const double x = std::log(poses), y = std::log(time_s);
    n += 1;
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  const double spread = n * sum_xx - sum_x * sum_x;
  if (n < 2 || !(spread > 0)) return std::nullopt;
  return (n * sum_xy - sum_x * sum_y) / spread;
}

// Line: median of a bin; marks: its largest.
void add_points(const std::map<double, double>& times_s, Curve& curve) {
  std::map<long, std::vector<double>> bins;
  std::map<long, std::vector<double>> poses;
  for (const auto& [num_poses, time_s] : times_s) {
    const long bin = std::lround(std::floor(kBinsPerDecade * std::log10(num_poses)));
    bins[bin].push_back(kMilliseconds * time_s);
    poses[bin].push_back(num_poses);
  }
  for (const auto& [bin, samples_ms] : bins) {
    const double x = *statistics::median(poses[bin]);
    curve.points.emplace_back(x, *statistics::median(samples_ms));
    curve.marks.emplace_back(x, *std::max_element(samples_ms.begin(), samples_ms.end()));
  }
}

}  // namespace

std::optional<Figure> update_figure(const Cases& graphs, const std::string& dataset,
                                    std::vector<std::string>& problems) {
  std::vector<Curve> curves;
  for (const Series& series : graphs.series()) {
    const auto times_s = undisturbed_s(graphs.of(dataset, series), problems);
    if (times_s.empty()) continue;
    Curve curve{graphs.label(series), &spare_style(curves.size()), {}, {}};
    if (const auto exponent = growth(times_s)) {
      curve.label += fmt::format(": grows as n^{:.2f}", *exponent);
    }
    add_points(times_s, curve);
    curves.push_back(std::move(curve));
  }
  const Axis x = log_axis("poses so far", curves, 0);
  const Axis y = log_axis("time of an update [ms]", curves, 1);
  if (y.high == 0) return std::nullopt;
  const double legend_px = kLegendRow_px * static_cast<double>(curves.size());
  Svg svg("updates-" + reports::file_name_from(dataset), kWidth_px,
          kTop_px + kPlotHeight_px + kBottom_px + legend_px,
          fmt::format("Time of an update on {}", dataset),
          "Time of an update over the number of poses so far, both axes logarithmic");
  draw_curves(svg, {kLeft_px, kTop_px, kWidth_px - kLeft_px - kRight_px, kPlotHeight_px}, x, y,
              curves);
  draw_legend(svg, kLeft_px, kTop_px + kPlotHeight_px + kBottom_px + 4, curves);
  return Figure{
      std::move(svg),
      fmt::format("Time of an update on {} over the number of poses so far: per number of poses "
                  "the smallest of all repeats, then the median (line) and the largest (marks) of "
                  "nearly equal numbers. Exponents are fitted over the last nine tenths of the "
                  "poses. {}",
                  dataset, reports::timing_notes(graphs).front())};
}

}  // namespace corridor::figures
