// Errors over the values of a scenario family: a line per system, with intervals, the Cramer-Rao
// bound, and in words who is shown to be the best where.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "datasets/formats/text.hpp"
#include "reports/escape.hpp"
#include "reports/figures/curves.hpp"
#include "reports/figures/report_figures.hpp"
#include "reports/figures/series_styles.hpp"
#include "reports/metrics.hpp"

namespace corridor::figures {
namespace {

using reports::Cases;
using reports::Series;
using tables::Metric;

constexpr double kWidth_px = 960;
constexpr double kPlotHeight_px = 300;
constexpr double kLeft_px = 64;
constexpr double kRight_px = 20;
constexpr double kTop_px = 40;
constexpr double kBottom_px = 50;
// Members stand one apart; beyond the first and last, and between all lines of a member.
constexpr double kMargin = 0.5;
constexpr double kSpread = 0.5;

struct Member {
  std::string value;  // behind the family's '@'
  std::string dataset;
};

// Numbers by size, then names as they are.
bool is_before(const Member& left, const Member& right) {
  const auto left_number = formats::parse_double(left.value);
  const auto right_number = formats::parse_double(right.value);
  if (left_number && right_number) return *left_number < *right_number;
  if (left_number.has_value() != right_number.has_value()) return left_number.has_value();
  return left.value < right.value;
}

// Where member `member` of line `line` stands on the horizontal axis.
double place(std::size_t member, std::size_t line, std::size_t num_lines) {
  const double middle = 0.5 * (static_cast<double>(num_lines) - 1);
  return static_cast<double>(member) +
         kSpread * (static_cast<double>(line) - middle) / static_cast<double>(num_lines);
}

void add_point(double x, const tables::Cell& cell, Curve& curve) {
  const auto* estimate = std::get_if<tables::Estimate>(&cell);
  if (estimate == nullptr || estimate->median <= 0) return;
  curve.points.emplace_back(x, estimate->median);
  if (estimate->low && estimate->high && *estimate->low > 0) {
    curve.whiskers.emplace_back(x, *estimate->low, *estimate->high);
  }
}

// A line for the bound, where there is one, and one per series with a value.
std::vector<Curve> curves_of(const Cases& cases, const std::vector<Member>& members,
                             const Metric& metric, const Metric& bound) {
  const SeriesStyles styles(cases);
  const std::vector<Series> all = cases.series();
  Curve limit{"Cramer-Rao bound", &truth_style(), {}, {}};
  std::vector<Curve> curves(all.size());
  for (std::size_t member = 0; member < members.size(); ++member) {
    const std::string& dataset = members[member].dataset;
    add_point(static_cast<double>(member), tables::summarise_worlds(cases, dataset, bound), limit);
    for (std::size_t line = 0; line < all.size(); ++line) {
      add_point(place(member, line, all.size()),
                tables::summarise(cases, dataset, all[line], metric), curves[line]);
    }
  }
  limit.whiskers.clear();
  for (std::size_t line = 0; line < all.size(); ++line) {
    curves[line].label = cases.label(all[line]);
    curves[line].style = &styles(all[line]);
    curves[line].marks = curves[line].points;
  }
  curves.insert(curves.begin(), std::move(limit));
  std::erase_if(curves, [](const Curve& curve) { return curve.points.empty(); });
  return curves;
}

// "fusion at 10, 20; karto at 35; nobody at 60".
std::string best_by_value(const Cases& cases, const std::vector<Member>& members,
                          const Metric& metric) {
  const std::vector<Series> all = cases.series();
  std::map<std::size_t, std::vector<std::string>> values_of;
  for (const Member& member : members) {
    std::vector<tables::WorldValues> values;
    values.reserve(all.size());
    for (const Series& series : all) {
      values.push_back(tables::world_values(cases, member.dataset, series, metric));
    }
    values_of[tables::clearly_smallest(values).value_or(all.size())].push_back(member.value);
  }
  std::vector<std::string> parts;
  for (const auto& [index, values] : values_of) {
    parts.push_back(fmt::format("{} at {}",
                                index == all.size() ? "nobody" : cases.label(all[index]),
                                fmt::join(values, ", ")));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

Axis member_axis(const std::string& family, const std::vector<Member>& members) {
  Axis axis{family, -kMargin, static_cast<double>(members.size()) - 1 + kMargin, false};
  for (std::size_t member = 0; member < members.size(); ++member) {
    axis.ticks.push_back({static_cast<double>(member), elided(members[member].value, 80)});
  }
  return axis;
}

std::vector<Member> members_of(const Cases& cases, const std::string& family) {
  std::vector<Member> members;
  for (const std::string& dataset : cases.datasets()) {
    if (family_of(dataset) != family) continue;
    members.push_back({dataset.substr(family.size() + 1), dataset});
  }
  std::sort(members.begin(), members.end(), is_before);
  return members;
}

}  // namespace

std::string family_of(const std::string& dataset) {
  const std::size_t at = dataset.rfind('@');
  return at == std::string::npos ? std::string() : dataset.substr(0, at);
}

std::optional<Figure> sweep_figure(const Cases& logs, const std::string& family) {
  const std::vector<Member> members = members_of(logs, family);
  if (members.size() < 2) return std::nullopt;
  const Cases cases = logs.only(
      [&](const results::RunResult& result) { return family_of(result.dataset) == family; });
  const std::vector<Curve> position =
      curves_of(cases, members, reports::position_error(), reports::position_bound());
  const std::vector<Curve> angle =
      curves_of(cases, members, reports::angle_error(), reports::angle_bound());
  if (position.empty() || angle.empty()) return std::nullopt;
  const double legend_px = kLegendRow_px * static_cast<double>(position.size() + 1);
  Svg svg("sweep-" + reports::file_name_from(family), kWidth_px,
          kTop_px + kPlotHeight_px + kBottom_px + legend_px, fmt::format("Errors over {}", family),
          "Median position and angle error of each system at every value, with intervals");
  const double plot_px = kWidth_px / 2 - kLeft_px - kRight_px;
  const Axis x = member_axis(family, members);
  draw_curves(svg, {kLeft_px, kTop_px, plot_px, kPlotHeight_px}, x,
              log_axis("position error [m]", position, 1), position);
  draw_curves(svg, {kWidth_px / 2 + kLeft_px, kTop_px, plot_px, kPlotHeight_px}, x,
              log_axis("angle error [deg]", angle, 1), angle);
  draw_legend(svg, kLeft_px, kTop_px + kPlotHeight_px + kBottom_px + kLegendRow_px, position);
  return Figure{
      std::move(svg),
      fmt::format(
          "Position and angle error (RMSE of the final trajectory, first poses aligned; "
          "logarithmic) at the values of {}, which stand evenly spaced: median over the "
          "worlds, bars are its 95 % bootstrap interval; lines of one value are moved apart "
          "a little. Shown to be smaller than every other's, position: {}. Angle: {}.",
          family, best_by_value(cases, members, reports::position_error()),
          best_by_value(cases, members, reports::angle_error()))};
}

}  // namespace corridor::figures
