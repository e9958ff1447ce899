#include "datasets/simulation/ray_casting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace corridor::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kCell_m = 1.0;
// Cells are widened by this when walls are entered, so that no ray through a cell's corner misses
// one.
constexpr double kCellOverlap_m = 1e-6;
// Walls are longer by this at both ends, so that no ray slips through a corner by rounding.
constexpr double kEndOverlap_m = 1e-9;
// Rays whose direction differs less from the wall's [rad] count as parallel.
constexpr double kParallel = 1e-12;

double cross(const Vector2d& u, const Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

// Separating axis of a segment and an axis-aligned square, the wall's normal being the only one
// that its bounding box has not already tried.
bool touches_cell(const Segment& wall, const Vector2d& centre_m) {
  const Vector2d along = wall.b_m - wall.a_m;
  const double reach_m = (kCell_m / 2 + kCellOverlap_m) * along.lpNorm<1>();
  return std::abs(cross(along, centre_m - wall.a_m)) <= reach_m;
}

// One axis of the walk through the grid [Amanatides1987].
struct AxisWalk {
  AxisWalk(double origin_cells, double direction, int cell_index) : cell(cell_index) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    step = direction > 0 ? 1 : -1;
    per_cell_m = direction == 0 ? kNever : kCell_m / std::abs(direction);
    const double to_border_cells = direction > 0 ? cell + 1 - origin_cells : origin_cells - cell;
    next_m = direction == 0 ? kNever : to_border_cells * per_cell_m;
  }
  void advance() {
    cell += step;
    next_m += per_cell_m;
  }

  int cell;
  int step;
  double per_cell_m;
  double next_m;  // distance along the ray to the next border on this axis
};

void keep_nearest(const std::optional<double>& range_m, std::size_t wall_index, double max_m,
                  std::optional<RayCaster::Hit>& nearest) {
  if (!range_m || *range_m > max_m) return;
  if (nearest && (nearest->range_m < *range_m ||
                  (nearest->range_m == *range_m && nearest->wall_index <= wall_index))) {
    return;
  }
  nearest = RayCaster::Hit{*range_m, wall_index};
}

}  // namespace

std::optional<double> distance_to_wall_m(const Segment& wall, const Vector2d& origin_m,
                                         const Vector2d& unit_direction) {
  const Vector2d along = wall.b_m - wall.a_m;
  const double length_m = along.norm();
  const double sine_m = cross(unit_direction, along);
  if (std::abs(sine_m) <= kParallel * length_m) return std::nullopt;
  const Vector2d to_wall = wall.a_m - origin_m;
  const double along_ratio = cross(to_wall, unit_direction) / sine_m;
  const double overlap_ratio = kEndOverlap_m / length_m;
  if (along_ratio < -overlap_ratio || along_ratio > 1 + overlap_ratio) return std::nullopt;
  const double range_m = cross(to_wall, along) / sine_m;
  if (range_m <= 0) return std::nullopt;
  return range_m;
}

RayCaster::RayCaster(const World& world) : walls_(world.walls) {
  if (walls_.empty()) return;
  Vector2d upper_m = walls_.front().a_m;
  lower_m_ = upper_m;
  for (const Segment& wall : walls_) {
    lower_m_ = lower_m_.cwiseMin(wall.a_m).cwiseMin(wall.b_m);
    upper_m = upper_m.cwiseMax(wall.a_m).cwiseMax(wall.b_m);
  }
  lower_m_.array() -= kCell_m / 2;
  const Vector2d extent_cells = (upper_m - lower_m_) / kCell_m;
  num_columns_ = static_cast<int>(std::ceil(extent_cells.x())) + 1;
  num_rows_ = static_cast<int>(std::ceil(extent_cells.y())) + 1;
  first_wall_.push_back(0);
  for (int row = 0; row < num_rows_; ++row) {
    for (int column = 0; column < num_columns_; ++column) {
      append_walls_of(lower_m_ + kCell_m * Vector2d(column + 0.5, row + 0.5));
      first_wall_.push_back(static_cast<std::uint32_t>(cell_walls_.size()));
    }
  }
}

void RayCaster::append_walls_of(const Vector2d& cell_centre_m) {
  constexpr double kReach_m = kCell_m / 2 + kCellOverlap_m;
  for (std::size_t i = 0; i < walls_.size(); ++i) {
    const Segment& wall = walls_[i];
    const Vector2d nearest_m =
        cell_centre_m.cwiseMax(wall.a_m.cwiseMin(wall.b_m)).cwiseMin(wall.a_m.cwiseMax(wall.b_m));
    const bool is_box_near = (nearest_m - cell_centre_m).lpNorm<Eigen::Infinity>() <= kReach_m;
    if (is_box_near && touches_cell(wall, cell_centre_m)) {
      cell_walls_.push_back(static_cast<std::uint32_t>(i));
    }
  }
}

std::span<const std::uint32_t> RayCaster::walls_of(int column, int row) const {
  const auto cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(num_columns_) +
                    static_cast<std::size_t>(column);
  return std::span(cell_walls_)
      .subspan(first_wall_[cell], first_wall_[cell + 1] - first_wall_[cell]);
}

std::optional<RayCaster::Hit> RayCaster::cast(const Vector2d& origin_m, double direction_rad,
                                              double max_m) const {
  const Vector2d direction(std::cos(direction_rad), std::sin(direction_rad));
  const Vector2d origin_cells = (origin_m - lower_m_) / kCell_m;
  const auto is_inside = [&](int column, int row) {
    return column >= 0 && row >= 0 && column < num_columns_ && row < num_rows_;
  };
  AxisWalk columns(origin_cells.x(), direction.x(), static_cast<int>(std::floor(origin_cells.x())));
  AxisWalk rows(origin_cells.y(), direction.y(), static_cast<int>(std::floor(origin_cells.y())));

  std::optional<Hit> nearest;
  if (!is_inside(columns.cell,
                 rows.cell)) {  // outside every wall's box: rare, so no walk to the grid
    for (std::size_t i = 0; i < walls_.size(); ++i) {
      keep_nearest(distance_to_wall_m(walls_[i], origin_m, direction), i, max_m, nearest);
    }
    return nearest;
  }
  for (double entered_m = 0; entered_m <= max_m && is_inside(columns.cell, rows.cell);) {
    for (const std::uint32_t i : walls_of(columns.cell, rows.cell)) {
      keep_nearest(distance_to_wall_m(walls_[i], origin_m, direction), i, max_m, nearest);
    }
    AxisWalk& axis = columns.next_m < rows.next_m ? columns : rows;
    entered_m = axis.next_m;
    if (nearest && nearest->range_m <= entered_m) return nearest;
    axis.advance();
  }
  return nearest;
}

std::optional<double> RayCaster::range_m(const Vector2d& origin_m, double direction_rad,
                                         double max_m) const {
  const std::optional<Hit> hit = cast(origin_m, direction_rad, max_m);
  if (!hit) return std::nullopt;
  return hit->range_m;
}

}  // namespace corridor::simulation
