// Performance profiles [Dolan2002]: for each solver the share of problems that it solves within a
// factor of the fastest solver's time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "bench/statistics/quantiles.hpp"
#include "reports/figures/curves.hpp"
#include "reports/figures/report_figures.hpp"
#include "reports/graph_cases.hpp"
#include "reports/timing.hpp"

namespace corridor::figures {
namespace {

using reports::Case;
using reports::Cases;
using reports::Series;

constexpr double kWidth_px = 860;
constexpr double kPlotHeight_px = 320;
constexpr double kLeft_px = 64;
constexpr double kTop_px = 40;
constexpr double kBottom_px = 50;
constexpr double kLegendWidth_px = 230;
// Space to the right of the largest ratio, so that its step is seen.
constexpr double kEnd_ratio = 1.5;

// A graph and how it is given: all that two solvers must have in common to be compared.
using Problem = std::tuple<std::string, std::string>;
struct Times {
  std::set<Problem> tried;
  std::map<Problem, double> solved_s;  // median over the repeats, if all of them solved it
};

// What solves: everything of a series but how the graph is given.
using Solver = std::tuple<std::string, std::string, std::string>;
Solver solver_of(const Series& series) {
  return {series.backend, series.overrides, series.git_revision};
}

std::map<Solver, Times> load_times(const Cases& graphs, const std::string& system) {
  std::map<Solver, Times> times;
  for (const std::string& dataset : graphs.datasets()) {
    for (const Series& series : graphs.series()) {
      const std::vector<const Case*> tried = graphs.of(dataset, series);
      if (series.system != system || tried.empty()) continue;
      const Problem problem(dataset, series.profile);
      Times& own = times[solver_of(series)];
      own.tried.insert(problem);
      std::vector<double> samples_s;
      for (const Case* entry : tried) {
        if (reports::is_solved(entry->result) && entry->result.wall_s) {
          samples_s.push_back(*entry->result.wall_s);
        }
      }
      if (samples_s.size() == tried.size()) own.solved_s[problem] = *statistics::median(samples_s);
    }
  }
  return times;
}

// Whoever was not given a problem has not failed at it: only those that all were given count.
std::set<Problem> keep_common(std::map<Solver, Times>& times) {
  std::set<Problem> common = times.empty() ? std::set<Problem>() : times.begin()->second.tried;
  for (const auto& [solver, own] : times) {
    std::erase_if(
        common, [&tried = own.tried](const Problem& problem) { return !tried.contains(problem); });
  }
  for (auto& [solver, own] : times) {
    std::erase_if(own.solved_s, [&](const auto& item) { return !common.contains(item.first); });
  }
  return common;
}

std::map<Problem, double> best_times(const std::map<Solver, Times>& times) {
  std::map<Problem, double> best;
  for (const auto& [solver, own] : times) {
    for (const auto& [problem, time_s] : own.solved_s) {
      const auto [place, is_new] = best.emplace(problem, time_s);
      place->second = std::min(place->second, time_s);
    }
  }
  return best;
}

// Steps upwards at each ratio; the last is drawn on to `end`.
std::vector<Eigen::Vector2d> staircase(std::vector<double> ratios, std::size_t num_problems,
                                       double end) {
  std::sort(ratios.begin(), ratios.end());
  std::vector<Eigen::Vector2d> points = {{1, 0}};
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    const double share = static_cast<double>(i + 1) / static_cast<double>(num_problems);
    points.emplace_back(ratios[i], points.back().y());
    points.emplace_back(ratios[i], share);
  }
  points.emplace_back(end, points.back().y());
  return points;
}

std::string text_of(const Solver& solver, const std::map<Solver, Times>& all) {
  const auto& [backend, overrides, revision] = solver;
  const auto has_namesake = [&, name = backend](const auto& item) {
    return std::get<0>(item.first) == name && item.first != solver;
  };
  const bool is_alone = std::none_of(all.begin(), all.end(), has_namesake);
  return is_alone ? backend : fmt::format("{} ({} at {})", backend, overrides, revision);
}

std::vector<Curve> load_curves(const std::map<Solver, Times>& times, std::size_t num_problems,
                               double& end) {
  const std::map<Problem, double> best = best_times(times);
  std::map<Solver, std::vector<double>> ratios;
  for (const auto& [solver, own] : times) {
    for (const auto& [problem, time_s] : own.solved_s) {
      ratios[solver].push_back(time_s / best.at(problem));
      end = std::max(end, kEnd_ratio * ratios[solver].back());
    }
  }
  std::vector<Curve> curves;
  for (const auto& [solver, own] : times) {
    curves.push_back(
        {fmt::format("{}: {}/{} solved", text_of(solver, times), own.solved_s.size(), num_problems),
         &spare_style(curves.size()),
         staircase(ratios[solver], num_problems, end),
         {}});
  }
  return curves;
}

}  // namespace

std::optional<Figure> profile_figure(const Cases& graphs, const std::string& system) {
  std::map<Solver, Times> times = load_times(graphs, system);
  const std::set<Problem> problems = keep_common(times);
  if (times.size() < 2 || problems.empty()) return std::nullopt;  // nobody to compare with
  double end = kEnd_ratio;
  const std::vector<Curve> curves = load_curves(times, problems.size(), end);
  Svg svg("profile-" + system, kWidth_px, kTop_px + kPlotHeight_px + kBottom_px,
          fmt::format("Performance profiles of {}", system),
          "For each back-end the share of problems solved within a factor of the fastest time");
  const PlotArea area{kLeft_px, kTop_px, kWidth_px - kLeft_px - kLegendWidth_px - 24,
                      kPlotHeight_px};
  draw_curves(svg, area, {"time / fastest back-end's time", 1, end},
              {"share of problems solved", 0, 1, false}, curves);
  draw_legend(svg, kWidth_px - kLegendWidth_px, kTop_px + 12, curves);
  return Figure{
      std::move(svg),
      fmt::format(
          "Performance profiles of {} [Dolan2002] over {} problems, each a graph and the way it is "
          "given, that every back-end was given: the share that a back-end solves within a factor "
          "of the fastest one's time "
          "(medians over repeats; a problem counts only if it was solved every time). Height at 1: "
          "how often it is the fastest; height at the right: how much it solves at all. {}",
          system, problems.size(), reports::timing_notes(graphs).front())};
}

}  // namespace corridor::figures
