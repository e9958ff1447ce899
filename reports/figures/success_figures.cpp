// Success over what makes a pose graph hard, a panel per graph: noise on the start, a line per
// back-end; false loop closures, a line per method. Whiskers are Wilson intervals [Wilson1927].
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <tuple>

#include "bench/statistics/wilson.hpp"
#include "reports/escape.hpp"
#include "reports/false_closures.hpp"
#include "reports/figures/curves.hpp"
#include "reports/figures/report_figures.hpp"
#include "reports/graph_cases.hpp"
#include "reports/series_labels.hpp"

namespace corridor::figures {
namespace {

using reports::Case;
using reports::Cases;
using reports::number_of;
using results::RunResult;
using Parameters = std::map<std::string, std::string>;

constexpr double kWidth_px = 960;
constexpr std::size_t kNumColumns = 2;
constexpr double kPlotHeight_px = 190;
constexpr double kLeft_px = 56;
constexpr double kRight_px = 20;
constexpr double kTop_px = 40;
constexpr double kBottom_px = 54;
// Beyond 0 and 1, and beyond the smallest and largest share: room for marks.
constexpr double kMargin = 0.08;
// Between the lines of a panel, of its axes: most of them lie at 0 and at 1. All of them stay in
// the margins.
constexpr double kApart_ratio = 0.014;
constexpr double kMaxApart_ratio = 0.06;
// A tick for each of 0, 10, ... 50 %.
constexpr int kShareTicks = 6;

// What is compared: a name, and all else that makes runs the same; runs that differ are not pooled.
struct Line {
  std::string name;
  Parameters others;

  // What does nothing comes first.
  bool operator<(const Line& right) const {
    using Key = std::tuple<bool, const std::string&, const Parameters&>;
    const auto key = [](const Line& line) {
      return Key(line.name != "none", line.name, line.others);
    };
    return key(*this) < key(right);
  }
};

struct Point {
  Line line;
  double x = 0;
};

struct Share {
  std::int64_t num_successes = 0, num_tried = 0;
  bool is_drawn = false;  // otherwise the runs are one run, repeated
};
// Per graph, line and x.
using Shares = std::map<std::string, std::map<Line, std::map<double, Share>>>;

struct Words {
  std::string id, title, description, caption;
};

// All parameters but those that a line or the axis stand for, and the code's revision.
Parameters others_of(const RunResult& result, std::initializer_list<const char*> but) {
  Parameters others = result.parameters;
  for (const char* name : but) others.erase(name);
  others["at"] = result.git_revision;
  return others;
}

Point noise_point(const RunResult& result) {
  const double heading_rad = number_of(result, "start_heading_sigma_rad");
  Parameters others = others_of(result, {"start_heading_sigma_rad", "start_position_sigma_m"});
  others["m per rad"] =
      fmt::format("{:g}", number_of(result, "start_position_sigma_m") / heading_rad);
  return {{result.backend.value_or(""), std::move(others)}, heading_rad};
}

Point closure_point(const RunResult& result) {
  return {{reports::method_of(result), others_of(result, {"robust", "false_closures"})},
          reports::false_share_of(result)};
}

Shares shares_of(const Cases& cases, Point (*point_of)(const RunResult&),
                 bool (*is_success)(const RunResult&)) {
  Shares shares;
  for (const Case& entry : cases.all()) {
    const Point point = point_of(entry.result);
    Share& share = shares[entry.result.dataset][point.line][point.x];
    ++share.num_tried;
    share.is_drawn = share.is_drawn || reports::is_drawn(entry.result);
    share.num_successes += is_success(entry.result) ? 1 : 0;
  }
  return shares;
}

// The name, and in brackets what tells lines of one name apart.
std::string label_of(const Line& line, const std::vector<Line>& lines) {
  std::vector<Parameters> namesakes;
  for (const Line& other : lines) {
    if (other.name == line.name) namesakes.push_back(other.others);
  }
  std::vector<std::string> differences;
  for (const std::string& key : reports::differing_keys(namesakes)) {
    const auto found = line.others.find(key);
    differences.push_back(
        fmt::format("{} {}", key, found == line.others.end() ? "none" : found->second));
  }
  if (differences.empty()) return line.name;
  return fmt::format("{} ({})", line.name, fmt::join(differences, ", "));
}

// One curve per line that any graph has, without points.
std::map<Line, Curve> empty_curves(const Shares& shares) {
  std::map<Line, Curve> curves;
  for (const auto& [dataset, by_line] : shares) {
    for (const auto& [line, by_x] : by_line) curves[line];
  }
  std::vector<Line> lines;
  for (const auto& [line, curve] : curves) lines.push_back(line);
  std::size_t index = 0;
  for (auto& [line, curve] : curves) {
    curve.label = label_of(line, lines);
    curve.style = &line_style(index++);
  }
  return curves;
}

// Moved by `offset` of both axes.
void add_points(const std::map<double, Share>& by_x, const Axis& x_axis, const Axis& y_axis,
                double offset, Curve& curve) {
  const double up = offset * (y_axis.high - y_axis.low);
  for (const auto& [x, share] : by_x) {
    const double at = x_axis.is_logarithmic ? x * std::pow(x_axis.high / x_axis.low, offset)
                                            : x + offset * (x_axis.high - x_axis.low);
    curve.points.emplace_back(
        at, up + static_cast<double>(share.num_successes) / static_cast<double>(share.num_tried));
    if (!share.is_drawn) continue;
    const auto interval = statistics::wilson_interval(share.num_successes, share.num_tried);
    curve.whiskers.emplace_back(at, up + interval->low, up + interval->high);
  }
  curve.marks = curve.points;
}

std::vector<Curve> curves_of(const std::map<Line, std::map<double, Share>>& by_line,
                             const std::map<Line, Curve>& empty, const Axis& x_axis,
                             const Axis& y_axis) {
  std::vector<Curve> curves;
  const double middle = 0.5 * (static_cast<double>(empty.size()) - 1);
  const double apart = std::min(kApart_ratio, kMaxApart_ratio / std::max(middle, 1.0));
  double index = 0;
  for (const auto& [line, curve] : empty) {
    const double offset = apart * (index++ - middle);
    const auto found = by_line.find(line);
    if (found == by_line.end()) continue;
    curves.push_back(curve);
    add_points(found->second, x_axis, y_axis, offset, curves.back());
  }
  return curves;
}

// How many runs are behind a point: "20", or "5 to 20".
std::string runs_per_point(const Shares& shares) {
  std::int64_t least = std::numeric_limits<std::int64_t>::max(), most = 0;
  for (const auto& [dataset, by_line] : shares) {
    for (const auto& [line, by_x] : by_line) {
      for (const auto& [x, share] : by_x) {
        least = std::min(least, share.num_tried);
        most = std::max(most, share.num_tried);
      }
    }
  }
  return least == most ? fmt::format("{}", most) : fmt::format("{} to {}", least, most);
}

Figure panels(const Words& words, const Shares& shares, const Axis& x_axis) {
  const Axis y_axis{"", -kMargin, 1 + kMargin, false};
  const std::map<Line, Curve> empty = empty_curves(shares);
  const double panel_px = kWidth_px / kNumColumns;
  const double row_px = kTop_px + kPlotHeight_px + kBottom_px;
  const auto num_rows = static_cast<double>((shares.size() + kNumColumns - 1) / kNumColumns);
  Svg svg(words.id, kWidth_px,
          num_rows * row_px + kLegendRow_px * static_cast<double>(empty.size() + 1), words.title,
          words.description);
  std::size_t index = 0;
  for (const auto& [dataset, by_line] : shares) {
    const double plot_px = panel_px - kLeft_px - kRight_px;
    const PlotArea area{static_cast<double>(index % kNumColumns) * panel_px + kLeft_px,
                        static_cast<double>(index / kNumColumns) * row_px + kTop_px, plot_px,
                        kPlotHeight_px};
    Axis named = y_axis;
    named.title = elided(dataset + ": share of runs that succeeded", plot_px);
    draw_curves(svg, area, x_axis, named, curves_of(by_line, empty, x_axis, y_axis));
    ++index;
  }
  std::vector<Curve> legend;
  for (const auto& [line, curve] : empty) {
    legend.push_back(curve);
    legend.back().marks.emplace_back(0, 0);
  }
  draw_legend(svg, kLeft_px, num_rows * row_px + kLegendRow_px, legend);
  return {std::move(svg),
          fmt::format("{} Points are shares of {} runs, each with its own seed, whiskers their "
                      "95 % intervals [Wilson1927], where the seed draws anything; lines are moved "
                      "apart a little, for most of them lie at 0 or 1.",
                      words.caption, runs_per_point(shares))};
}

}  // namespace

std::optional<Figure> initial_noise_figure(const Cases& graphs) {
  const Cases cases = graphs.only(
      [](const RunResult& result) { return number_of(result, "start_heading_sigma_rad") > 0; });
  if (cases.all().empty()) return std::nullopt;
  const Shares shares = shares_of(cases, noise_point, reports::is_solved);
  Curve all;
  for (const Case& entry : cases.all()) all.points.emplace_back(noise_point(entry.result).x, 1);
  return panels({"initial-noise", "Success over noise on the start",
                 "Per graph the share of runs of each back-end that solved it, over the noise on "
                 "the headings it started from",
                 fmt::format("How often a graph was solved (chi2 within {:g} of the best known) "
                             "over the standard deviation of the noise on its start.",
                             reports::kSolvedAtOnce_ratio)},
                shares, log_axis("noise on headings [rad]", {all}, 0));
}

std::optional<Figure> false_closure_figure(const Cases& cases, const std::string& backend) {
  const Cases own =
      cases.only([&](const RunResult& result) { return result.backend.value_or("") == backend; });
  double largest = 0;
  for (const Case& entry : own.all()) {
    largest = std::max(largest, reports::false_share_of(entry.result));
  }
  if (largest == 0) return std::nullopt;  // nothing planted, nothing to show it over
  const Axis x_axis{"share of closures that are false", -kMargin * largest, (1 + kMargin) * largest,
                    false, kShareTicks};
  return panels(
      {"false-closures-" + reports::file_name_from(backend),
       fmt::format("Success over false loop closures with {}", backend),
       "Per graph the share of runs of each method that found it again, over the share of false "
       "closures",
       fmt::format(
           "How often {} found a graph again (chi2 of the true edges at most {:.0f} % above "
           "the best known) over the share of false loop closures, by method.",
           backend, 100 * reports::kFoundAgain_ratio)},
      shares_of(own, closure_point, reports::is_found_again), x_axis);
}

}  // namespace corridor::figures
