#include "bench/metrics/wall_line_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace corridor::metrics {
namespace {

// Parameters, in this order: (offset_m, angle_rad, ln scatter_m).
using Parameters = Eigen::Vector3d;

constexpr double kMinScatter_m = 0.003;
constexpr double kMaxScatter_m = 0.3;
constexpr double kStartScatter_m = 0.05;
// Where all hits lie in one or two rows of cells, the counts fix offset / scatter only. This prior,
// which weighs as much as one hit, then settles on what LiDARs do: ln s = ln 12 mm +- 0.7.
constexpr double kPriorScatter_m = 0.012;
constexpr double kPriorLogSigma = 0.7;
constexpr double kMinBackground = 1e-3;
constexpr double kMaxBackground = 0.6;
constexpr double kStartBackground = 0.1;
constexpr int kMaxIterations = 100;
constexpr double kConvergedStep = 1e-7;  // m, rad
constexpr double kMinBoxRatio = 1e-3;    // a thinner side of a footprint is no side
constexpr std::array kStartOffsetRatios{-0.5, 0.0, 0.5};  // of the band's half width

double normal_density(double u) { return std::exp(-0.5 * u * u) / std::sqrt(2 * std::numbers::pi); }
double normal_cdf(double u) { return 0.5 * std::erfc(-u / std::numbers::sqrt2); }

// Mean over a cell of the normal density of the distance to the line, and its derivatives.
struct Density {
  double value = 0;  // [1/m]
  double by_distance = 0;
  double by_log_scatter = 0;
};

// Seen along the line, a square's shadow is the convolution of two boxes h1 >= h2 wide. The mean
// over it is a second difference of G(u) = u Phi(u/s) + s phi(u/s), whose second derivative is the
// normal density.
Density mean_density(double r, double scatter_m, double h1, double h2) {
  if (h2 < kMinBoxRatio * h1) {
    const double upper = (r + h1 / 2) / scatter_m;
    const double lower = (r - h1 / 2) / scatter_m;
    const double density_upper = normal_density(upper);
    const double density_lower = normal_density(lower);
    return {(normal_cdf(upper) - normal_cdf(lower)) / h1,
            (density_upper - density_lower) / (scatter_m * h1),
            -(upper * density_upper - lower * density_lower) / h1};
  }
  Density sum;
  const double outer = (h1 + h2) / 2;
  const double inner = (h1 - h2) / 2;
  for (const auto& [u, sign] :
       {std::pair{r + outer, 1}, {r + inner, -1}, {r - inner, -1}, {r - outer, 1}}) {
    const double cdf = normal_cdf(u / scatter_m);
    const double density = normal_density(u / scatter_m);
    sum.value += sign * (u * cdf + scatter_m * density);
    sum.by_distance += sign * cdf;
    sum.by_log_scatter += sign * scatter_m * density;
  }
  const double area = h1 * h2;
  return {std::max(sum.value / area, 0.0), sum.by_distance / area, sum.by_log_scatter / area};
}

struct Problem {
  std::span<const WallCell> cells;
  CellShape shape;
  double background_density = 0;  // of a hit that belongs to no wall [1/m]
};

struct Evaluation {
  double log_likelihood = 0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // outer products of the gradients
  double mean_membership = 0;
};

Density density_of_cell(const Problem& problem, const Parameters& p, const WallCell& cell,
                        double* distance_m) {
  const double cosine = std::cos(p[1]);
  const double sine = std::sin(p[1]);
  const double grid_angle = problem.shape.wall_angle_rad + p[1];
  const double side_a = problem.shape.resolution_m * std::abs(std::cos(grid_angle));
  const double side_b = problem.shape.resolution_m * std::abs(std::sin(grid_angle));
  *distance_m = -sine * cell.centre_wall_m.x() + cosine * (cell.centre_wall_m.y() - p[0]);
  return mean_density(*distance_m, std::exp(p[2]), std::max(side_a, side_b),
                      std::min(side_a, side_b));
}

Evaluation evaluate(const Problem& problem, const Parameters& p, double background_ratio) {
  Evaluation result;
  const double cosine = std::cos(p[1]);
  const double sine = std::sin(p[1]);
  double total_hits = 0;
  for (const WallCell& cell : problem.cells) {
    double r = 0;
    const Density wall = density_of_cell(problem, p, cell, &r);
    const double density =
        (1 - background_ratio) * wall.value + background_ratio * problem.background_density;
    // d r / d (offset, angle)
    const double by_angle =
        -cosine * cell.centre_wall_m.x() - sine * (cell.centre_wall_m.y() - p[0]);
    const Eigen::Vector3d score = (1 - background_ratio) / density *
                                  Eigen::Vector3d(-cosine * wall.by_distance,
                                                  by_angle * wall.by_distance, wall.by_log_scatter);
    result.log_likelihood += cell.hits * std::log(density);
    result.gradient += cell.hits * score;
    result.information += cell.hits * score * score.transpose();
    result.mean_membership += cell.hits * (1 - background_ratio) * wall.value / density;
    total_hits += cell.hits;
  }
  result.mean_membership /= total_hits;
  const double prior = (p[2] - std::log(kPriorScatter_m)) / kPriorLogSigma;
  result.log_likelihood -= 0.5 * prior * prior;
  result.gradient[2] -= prior / kPriorLogSigma;
  result.information(2, 2) += 1 / (kPriorLogSigma * kPriorLogSigma);
  return result;
}

// Levenberg-Marquardt on the likelihood with the outer-product information, the background share
// updated by expectation-maximisation between steps.
WallLine maximise(const Problem& problem, Parameters p) {
  double background_ratio = kStartBackground;
  double damping = 1e-3;
  Evaluation current = evaluate(problem, p, background_ratio);
  for (int i = 0; i < kMaxIterations; ++i) {
    Eigen::Matrix3d damped = current.information;
    damped.diagonal() += damping * current.information.diagonal() + Eigen::Vector3d::Constant(1e-9);
    const Eigen::Vector3d step = damped.ldlt().solve(current.gradient);
    Parameters candidate = p + step;
    candidate[2] = std::clamp(candidate[2], std::log(kMinScatter_m), std::log(kMaxScatter_m));
    const Evaluation next = evaluate(problem, candidate, background_ratio);
    const bool is_converged = step.cwiseAbs().maxCoeff() < kConvergedStep;
    if (!(next.log_likelihood > current.log_likelihood)) {
      if (is_converged || damping > 1e9) break;
      damping *= 8;
      continue;
    }
    p = candidate;
    damping = std::max(damping / 4, 1e-9);
    background_ratio = std::clamp(1 - next.mean_membership, kMinBackground, kMaxBackground);
    current = evaluate(problem, p, background_ratio);
    if (is_converged) break;
  }
  return {p[0], p[1], std::exp(p[2]), background_ratio, current.log_likelihood};
}

}  // namespace

double WallLine::distance_m(const Eigen::Vector2d& point_wall_m) const {
  return -std::sin(angle_rad) * point_wall_m.x() +
         std::cos(angle_rad) * (point_wall_m.y() - offset_m);
}

std::optional<WallLine> fit_wall_line(std::span<const WallCell> cells, const CellShape& shape,
                                      double band_half_width_m) {
  const auto [first, last] =
      std::minmax_element(cells.begin(), cells.end(), [](const WallCell& a, const WallCell& b) {
        return a.centre_wall_m.x() < b.centre_wall_m.x();
      });
  if (cells.size() < 2 || !(last->centre_wall_m.x() > first->centre_wall_m.x()))
    return std::nullopt;
  const Problem problem{cells, shape, 1 / (2 * band_half_width_m)};
  std::optional<WallLine> best;
  for (const double ratio : kStartOffsetRatios) {
    const WallLine line =
        maximise(problem, {ratio * band_half_width_m, 0, std::log(kStartScatter_m)});
    const bool is_turned = !(std::abs(line.angle_rad) < std::numbers::pi / 2);
    if (!is_turned && (!best || line.log_likelihood > best->log_likelihood)) best = line;
  }
  return best;
}

double wall_membership(const WallCell& cell, const WallLine& line, const CellShape& shape,
                       double band_half_width_m) {
  const Problem problem{{}, shape, 1 / (2 * band_half_width_m)};
  double distance_m = 0;
  const Density wall = density_of_cell(
      problem, {line.offset_m, line.angle_rad, std::log(line.scatter_m)}, cell, &distance_m);
  const double of_wall = (1 - line.background_ratio) * wall.value;
  return of_wall / (of_wall + line.background_ratio * problem.background_density);
}

}  // namespace corridor::metrics
