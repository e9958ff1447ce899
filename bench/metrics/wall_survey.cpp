#include "bench/metrics/wall_survey.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "bench/metrics/association.hpp"
#include "bench/statistics/quantiles.hpp"

namespace corridor::metrics {
namespace {

// Hits nearer to a wall's end than this may be those of the wall that begins there.
constexpr double kEnd_m = 0.2;
constexpr double kSameLine_m = 1e-6;
constexpr double kBandPerDisagreement = 3;
constexpr double kMaxDisagreement_m = 0.3;
constexpr std::size_t kMinCells = 20;
constexpr std::size_t kMinSlabs = 3;
constexpr double kMinSeen_m = 1;
constexpr double kMaxScatter_m = 0.15;      // thicker is no wall
constexpr double kMaxSlabScatter_m = 0.15;  // more crooked is no line
constexpr double kMaxBackgroundRatio = 0.5;
constexpr double kMaxDoubledRatio = 0.3;  // of the slabs

tl::unexpected<std::string> no_line(std::string reason) {
  return tl::make_unexpected(std::move(reason));
}

double median_of(std::span<const double> values) { return statistics::median(values).value_or(0); }

// Position along the stretch's wall, if the point lies on the wall.
std::optional<double> along_wall_m(const simulation::Segment& wall,
                                   const Eigen::Vector2d& point_m) {
  const Eigen::Vector2d along = (wall.b_m - wall.a_m).normalized();
  const Eigen::Vector2d from_begin_m = point_m - wall.a_m;
  const double across_m = along.x() * from_begin_m.y() - along.y() * from_begin_m.x();
  if (std::abs(across_m) > kSameLine_m) return std::nullopt;
  return along.dot(from_begin_m);
}

// The frame whose x axis is the line of least squares through points, pointing the way they are
// ordered.
Pose2 frame_through(std::span<const Eigen::Vector2d> points_map_m) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& point : points_map_m) mean += point / static_cast<double>(points_map_m.size());
  double sxx = 0, sxy = 0, syy = 0;
  for (const auto& point : points_map_m) {
    const Eigen::Vector2d d = point - mean;
    sxx += d.x() * d.x();
    sxy += d.x() * d.y();
    syy += d.y() * d.y();
  }
  const double axis_rad = 0.5 * std::atan2(2 * sxy, sxx - syy);
  const Eigen::Vector2d axis(std::cos(axis_rad), std::sin(axis_rad));
  const bool is_forward = axis.dot(points_map_m.back() - points_map_m.front()) >= 0;
  return {mean.x(), mean.y(), is_forward ? axis_rad : axis_rad + std::numbers::pi};
}

// Why a fitted line is not to be trusted; empty if it is.
std::string doubt_about(const WallLine& line, const SlabStatistics& slabs) {
  const double slab_scatter_m = std::sqrt(slabs.residual_variance_m2);
  if (slabs.num_slabs < kMinSlabs) {
    return fmt::format("too little of it ({} slabs)", slabs.num_slabs);
  }
  if (slabs.doubled_ratio > kMaxDoubledRatio) return "the wall is doubled";
  if (line.scatter_m > kMaxScatter_m) {
    return fmt::format("no wall, hits scatter by {:.2f} m", line.scatter_m);
  }
  if (slab_scatter_m > kMaxSlabScatter_m) {
    return fmt::format("the wall is bent by {:.2f} m", slab_scatter_m);
  }
  if (line.background_ratio > kMaxBackgroundRatio) {
    return fmt::format("ambiguous, {:.0f} % of the hits are elsewhere",
                       100 * line.background_ratio);
  }
  return {};
}

// |sin| of the angle to the nearer axis of the grid.
double sine_to_grid(double direction_rad) {
  return std::min(std::abs(std::sin(direction_rad)), std::abs(std::cos(direction_rad)));
}

}  // namespace

WallStretch whole(const simulation::Segment& wall) { return {wall, 0, wall.length_m()}; }

WallSurvey::WallSurvey(const GridMap& map, const Trajectory& estimate,
                       const Trajectory& truth_world, const simulation::World& world,
                       double lidar_range_m)
    : resolution_m_(map.resolution_m()) {
  if (map.empty()) {
    emptiness_ = "the map is empty";
    return;
  }
  const auto pairs = associate(estimate, truth_world, AssociationRule::kNearest).pairs;
  if (pairs.empty()) {
    emptiness_ = "no estimated pose has a true one";
    return;
  }
  points_ = believe_walls(pairs, world, lidar_range_m);
  if (points_.empty()) {
    emptiness_ = "no wall was seen";
    return;
  }
  assign_cells(map);
}

void WallSurvey::assign_cells(const GridMap& map) {
  for (int row = 0; row < map.num_rows(); ++row) {
    for (int column = 0; column < map.num_columns(); ++column) {
      has_hit_counts_ = has_hit_counts_ || map.at(column, row).hits > 0;
    }
  }
  for (int row = 0; row < map.num_rows(); ++row) {
    for (int column = 0; column < map.num_columns(); ++column) {
      const GridCell& cell = map.at(column, row);
      const double occupancy = 2 * (probability_from_log_odds(cell.log_odds) - 0.5);
      const double hits = has_hit_counts_ ? static_cast<double>(cell.hits) : occupancy;
      if (!(hits > 0) || !std::isfinite(hits)) continue;
      const Eigen::Vector2d centre_m = map.centre_m(column, row);
      double nearest_m2 = kMaxBand_m * kMaxBand_m;
      std::optional<std::size_t> nearest;
      for (std::size_t k = 0; k < points_.size(); ++k) {
        const double distance_m2 = (points_[k].point_map_m - centre_m).squaredNorm();
        if (distance_m2 > nearest_m2) continue;
        nearest_m2 = distance_m2;
        nearest = k;
      }
      if (nearest) cells_.push_back({centre_m, hits, *nearest});
    }
  }
  if (cells_.empty()) emptiness_ = "the map holds nothing where the walls are expected";
}

std::optional<WallSurvey::ExpectedWall> WallSurvey::expect(const WallStretch& stretch) const {
  const double begin_m = std::max(stretch.begin_m, kEnd_m);
  const double end_m = std::min(stretch.end_m, stretch.wall.length_m() - kEnd_m);
  ExpectedWall expected;
  expected.is_point_on_it.assign(points_.size(), false);
  std::vector<std::pair<double, std::size_t>> order;  // position along the true wall, point
  std::vector<double> disagreements_m;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const auto along_m = along_wall_m(stretch.wall, points_[k].point_world_m);
    if (!along_m || *along_m < begin_m || *along_m > end_m) continue;
    expected.is_point_on_it[k] = true;
    order.emplace_back(*along_m, k);
    disagreements_m.push_back(points_[k].disagreement_m);
  }
  std::sort(order.begin(), order.end());
  if (order.empty() || order.back().first - order.front().first < kMinSeen_m) return std::nullopt;
  std::vector<Eigen::Vector2d> points_map_m;
  points_map_m.reserve(order.size());
  for (const auto& [along_m, k] : order) points_map_m.push_back(points_[k].point_map_m);
  expected.T_map_wall = frame_through(points_map_m);
  expected.disagreement_m = median_of(disagreements_m);
  expected.band_m =
      std::clamp(kBandPerDisagreement * expected.disagreement_m, kMinBand_m, kMaxBand_m);
  return expected;
}

std::vector<WallCell> WallSurvey::cells_of(const ExpectedWall& expected) const {
  std::vector<WallCell> cells;
  const Pose2 T_wall_map = expected.T_map_wall.inverse();
  for (const SurveyedCell& cell : cells_) {
    const double distance_m = (cell.centre_map_m - points_[cell.point_index].point_map_m).norm();
    if (!expected.is_point_on_it[cell.point_index] || distance_m > expected.band_m) continue;
    cells.push_back({T_wall_map * cell.centre_map_m, cell.hits});
  }
  return cells;
}

tl::expected<MeasuredWall, std::string> WallSurvey::measure(const WallStretch& stretch) const {
  if (!emptiness_.empty()) return no_line(emptiness_);
  const auto expected = expect(stretch);
  if (!expected) return no_line("the wall was not seen");
  if (expected->disagreement_m > kMaxDisagreement_m) {
    return no_line(fmt::format("ambiguous, the scans that saw it disagree by {:.2f} m",
                               expected->disagreement_m));
  }
  const auto cells = cells_of(*expected);
  if (cells.size() < kMinCells) return no_line(fmt::format("too few cells ({})", cells.size()));
  const CellShape shape{resolution_m_, expected->T_map_wall.theta_rad()};
  const auto line = fit_wall_line(cells, shape, expected->band_m);
  if (!line) return no_line("no line fits the cells");
  const auto slabs = slab_statistics(cells, *line, shape, expected->band_m, kSlab_m);
  if (const std::string doubt = doubt_about(*line, slabs); !doubt.empty()) return no_line(doubt);
  MeasuredWall wall = measured_wall(*expected, *line, slabs);
  wall.num_cells = cells.size();
  return wall;
}

MeasuredWall WallSurvey::measured_wall(const ExpectedWall& expected, const WallLine& line,
                                       const SlabStatistics& slabs) const {
  MeasuredWall wall;
  const Eigen::Vector2d along(std::cos(line.angle_rad), std::sin(line.angle_rad));
  const Eigen::Vector2d origin_wall_m(0, line.offset_m);
  wall.point_map_m = expected.T_map_wall * (origin_wall_m + slabs.mean_along_m / along.x() * along);
  wall.direction_rad = expected.T_map_wall.theta_rad() + line.angle_rad;
  wall.begin_m = slabs.first_along_m - slabs.mean_along_m;
  wall.end_m = slabs.last_along_m - slabs.mean_along_m;
  wall.scatter_m = line.scatter_m;

  const double length_m = wall.end_m - wall.begin_m;
  const double num_rows =
      std::max(1.0, length_m * sine_to_grid(wall.direction_rad) / resolution_m_);
  const double grid_m =
      has_hit_counts_ ? kHitGridRatio * resolution_m_ / num_rows
                      : resolution_m_ * std::hypot(1 / std::sqrt(12.0) / num_rows, kFaceRatio);
  const double variance_m2 =
      slabs.residual_variance_m2 + expected.disagreement_m * expected.disagreement_m;
  wall.offset_sigma_m =
      std::sqrt(variance_m2 / static_cast<double>(slabs.num_slabs) + grid_m * grid_m);
  wall.direction_sigma_rad =
      std::sqrt(variance_m2 / slabs.sum_along_m2 + 12 * grid_m * grid_m / (length_m * length_m));
  return wall;
}

}  // namespace corridor::metrics
