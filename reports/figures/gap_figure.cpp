// How far incremental solutions are from the batch optimum along the run: chi2 and newest pose.
#include <fmt/format.h>

#include <algorithm>

#include "reports/escape.hpp"
#include "reports/figures/curves.hpp"
#include "reports/figures/report_figures.hpp"
#include "reports/graph_cases.hpp"

namespace corridor::figures {
namespace {

using reports::Case;
using reports::Cases;
using reports::Series;

constexpr double kWidth_px = 960;
constexpr double kPlotHeight_px = 260;
constexpr double kLeft_px = 76;
constexpr double kGap_px = 90;
constexpr double kTop_px = 40;
constexpr double kBottom_px = 50;
// Smaller gaps are drawn at this height: nothing that anybody needs, and a logarithm needs a floor.
constexpr double kMinGap_ratio = 1e-9;
constexpr double kMinGap_m = 1e-7;

// The first case of a series: repeats differ in their times alone.
const Case* first_with_updates(const std::vector<const Case*>& cases) {
  for (const Case* entry : cases) {
    if (reports::is_pose_by_pose(entry->result)) return entry;
  }
  return nullptr;
}

void add_points(const std::vector<reports::UpdateRow>& rows, Curve& chi2, Curve& newest) {
  for (const reports::UpdateRow& row : rows) {
    if (!row.checkpoint) continue;
    const reports::Checkpoint& at = *row.checkpoint;
    newest.points.emplace_back(row.num_poses, std::max(at.newest_gap_m, kMinGap_m));
    if (at.chi2_optimum <= results::kExactFit_chi2) continue;
    chi2.points.emplace_back(row.num_poses, std::max(at.chi2 / at.chi2_optimum - 1, kMinGap_ratio));
  }
}

}  // namespace

std::optional<Figure> gap_figure(const Cases& graphs, const std::string& dataset,
                                 std::vector<std::string>& problems) {
  std::vector<Curve> chi2;
  std::vector<Curve> newest;
  for (const Series& series : graphs.series()) {
    const Case* entry = first_with_updates(graphs.of(dataset, series));
    if (entry == nullptr) continue;
    const auto rows = reports::read_updates(entry->dir);
    if (!rows) {
      problems.push_back(rows.error().to_line());
      continue;
    }
    const SeriesStyle& style = spare_style(chi2.size());
    chi2.push_back({graphs.label(series), &style, {}, {}});
    newest.push_back({graphs.label(series), &style, {}, {}});
    add_points(*rows, chi2.back(), newest.back());
  }
  const Axis chi2_axis = log_axis("chi2 / optimum of the graph so far - 1", chi2, 1);
  const Axis newest_axis = log_axis("newest pose, distance to its optimum [m]", newest, 1);
  if (chi2_axis.high == 0 || newest_axis.high == 0) return std::nullopt;
  const double legend_px = kLegendRow_px * static_cast<double>(chi2.size());
  Svg svg("gap-" + reports::file_name_from(dataset), kWidth_px,
          kTop_px + kPlotHeight_px + kBottom_px + legend_px,
          fmt::format("Gap to the batch optimum along the run on {}", dataset),
          "Relative gap of chi2 and distance of the newest pose, over the number of poses so far");
  const Axis poses{"poses so far", 0, log_axis("", newest, 0).high, false};
  const double width_px = (kWidth_px - kLeft_px - kGap_px - 16) / 2;
  draw_curves(svg, {kLeft_px, kTop_px, width_px, kPlotHeight_px}, poses, chi2_axis, chi2);
  draw_curves(svg, {kLeft_px + width_px + kGap_px, kTop_px, width_px, kPlotHeight_px}, poses,
              newest_axis, newest);
  draw_legend(svg, kLeft_px, kTop_px + kPlotHeight_px + kBottom_px + 4, chi2);
  return Figure{
      std::move(svg),
      fmt::format("Gap to the batch optimum of the graph so far, along the run on {}: chi2 (left) "
                  "and the newest pose (right), at checkpoints of a replay. The optimum is the "
                  "smallest that our own least squares find from the estimate and from the optimum "
                  "before; until the first closure there is no ratio.",
                  dataset)};
}

}  // namespace corridor::figures
