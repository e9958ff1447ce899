#include "datasets/simulation/ray_casting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace corridor::simulation {
namespace {

using Eigen::Vector2d;

// Cells of about this many surfaces' mean length, within limits, so that a cell names few.
constexpr double kSmallestCell_m = 0.25;
constexpr double kLargestCell_m = 1.0;
constexpr double kMaxCells = 4e6;
// Cells are widened by this when surfaces are entered, so that no ray through a cell's corner
// misses one.
constexpr double kCellOverlap_m = 1e-6;

double cross(const Vector2d& u, const Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

struct Box {
  Vector2d lower_m, upper_m;
};

Box box_of(const Segment& wall) {
  return {wall.a_m.cwiseMin(wall.b_m), wall.a_m.cwiseMax(wall.b_m)};
}

// Of the whole circle: a looser box costs a little time, never an answer.
Box box_of(const Arc& arc) {
  const Vector2d radius = Vector2d::Constant(arc.radius_m);
  return {arc.centre_m - radius, arc.centre_m + radius};
}

// Separating axis of a segment and an axis-aligned square, the wall's normal being the only one
// that its bounding box has not already tried.
bool touches_cell(const Segment& wall, const Vector2d& centre_m, double cell_m) {
  const Vector2d along = wall.b_m - wall.a_m;
  const double reach_m = (cell_m / 2 + kCellOverlap_m) * along.lpNorm<1>();
  return std::abs(cross(along, centre_m - wall.a_m)) <= reach_m;
}

// The circle passes the square: its radius lies between the nearest and the farthest point of it.
bool touches_cell(const Arc& arc, const Vector2d& centre_m, double cell_m) {
  const double half_m = cell_m / 2 + kCellOverlap_m;
  const Vector2d offset = (centre_m - arc.centre_m).cwiseAbs();
  const double nearest_m = (offset.array() - half_m).max(0.0).matrix().norm();
  const double farthest_m = (offset.array() + half_m).matrix().norm();
  return nearest_m <= arc.radius_m && arc.radius_m <= farthest_m;
}

// One axis of the walk through the grid [Amanatides1987].
struct AxisWalk {
  AxisWalk(double origin_cells, double direction, double cell_m)
      : cell(static_cast<int>(std::floor(origin_cells))) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    step = direction > 0 ? 1 : -1;
    per_cell_m = direction == 0 ? kNever : cell_m / std::abs(direction);
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

}  // namespace

struct RayCaster::Ray {
  Vector2d origin_m, direction;
  double min_m, max_m;
};

RayCaster::RayCaster(const World& world) : walls_(world.walls), arcs_(world.arcs) {
  if (walls_.empty() && arcs_.empty()) return;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Vector2d upper_m = Vector2d::Constant(-kFar);
  lower_m_ = Vector2d::Constant(kFar);
  double length_m = 0;
  const auto include = [&](const auto& surface) {
    const Box box = box_of(surface);
    lower_m_ = lower_m_.cwiseMin(box.lower_m);
    upper_m = upper_m.cwiseMax(box.upper_m);
    length_m += surface.length_m();
  };
  for (const Segment& wall : walls_) include(wall);
  for (const Arc& arc : arcs_) include(arc);
  const Vector2d extent_m = upper_m - lower_m_;
  const double mean_m = length_m / static_cast<double>(walls_.size() + arcs_.size());
  cell_m_ = std::max(std::clamp(mean_m, kSmallestCell_m, kLargestCell_m),
                     std::sqrt(extent_m.x() * extent_m.y() / kMaxCells));
  lower_m_.array() -= cell_m_ / 2;
  const Vector2d extent_cells = (upper_m - lower_m_) / cell_m_;
  num_columns_ = static_cast<int>(std::ceil(extent_cells.x())) + 1;
  num_rows_ = static_cast<int>(std::ceil(extent_cells.y())) + 1;
  fill_grid();
}

// Counts, then places: the lists of all cells lie in one array.
void RayCaster::fill_grid() {
  const auto num_cells =
      static_cast<std::size_t>(num_columns_) * static_cast<std::size_t>(num_rows_);
  first_surface_.assign(num_cells + 1, 0);
  const std::size_t num_surfaces = walls_.size() + arcs_.size();
  for (std::size_t i = 0; i < num_surfaces; ++i) {
    for_each_cell_of(i, [&](std::size_t cell) { ++first_surface_[cell + 1]; });
  }
  for (std::size_t cell = 0; cell < num_cells; ++cell) {
    first_surface_[cell + 1] += first_surface_[cell];
  }
  cell_surfaces_.resize(first_surface_.back());
  std::vector<std::uint32_t> next(first_surface_.begin(), first_surface_.end() - 1);
  for (std::size_t i = 0; i < num_surfaces; ++i) {
    for_each_cell_of(
        i, [&](std::size_t cell) { cell_surfaces_[next[cell]++] = static_cast<std::uint32_t>(i); });
  }
}

template <class Visitor>
void RayCaster::for_each_cell_of(std::size_t surface_index, Visitor&& visitor) const {
  const auto visit = [&](const auto& surface) {
    const Box box = box_of(surface);
    const auto index_of = [&](double cells, int limit) {
      return std::clamp(static_cast<int>(std::floor(cells)), 0, limit - 1);
    };
    const Vector2d first = (box.lower_m - lower_m_).array() / cell_m_ - kCellOverlap_m;
    const Vector2d last = (box.upper_m - lower_m_).array() / cell_m_ + kCellOverlap_m;
    for (int row = index_of(first.y(), num_rows_); row <= index_of(last.y(), num_rows_); ++row) {
      for (int column = index_of(first.x(), num_columns_);
           column <= index_of(last.x(), num_columns_); ++column) {
        const Vector2d centre_m = lower_m_ + cell_m_ * Vector2d(column + 0.5, row + 0.5);
        if (!touches_cell(surface, centre_m, cell_m_)) continue;
        visitor(static_cast<std::size_t>(row) * static_cast<std::size_t>(num_columns_) +
                static_cast<std::size_t>(column));
      }
    }
  };
  if (surface_index < walls_.size()) {
    visit(walls_[surface_index]);
  } else {
    visit(arcs_[surface_index - walls_.size()]);
  }
}

std::span<const std::uint32_t> RayCaster::surfaces_of(int column, int row) const {
  const auto cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(num_columns_) +
                    static_cast<std::size_t>(column);
  return std::span(cell_surfaces_)
      .subspan(first_surface_[cell], first_surface_[cell + 1] - first_surface_[cell]);
}

void RayCaster::try_surface(const Ray& ray, std::uint32_t surface_index,
                            std::optional<Hit>& nearest) const {
  const std::optional<double> range_m =
      surface_index < walls_.size()
          ? distance_to_m(walls_[surface_index], ray.origin_m, ray.direction, ray.min_m)
          : distance_to_m(arcs_[surface_index - walls_.size()], ray.origin_m, ray.direction,
                          ray.min_m);
  if (!range_m || *range_m > ray.max_m) return;
  if (nearest && (nearest->range_m < *range_m ||
                  (nearest->range_m == *range_m && nearest->surface_index <= surface_index))) {
    return;
  }
  nearest = Hit{*range_m, surface_index};
}

void RayCaster::try_all(const Ray& ray, std::optional<Hit>& nearest) const {
  for (std::size_t i = 0; i < walls_.size() + arcs_.size(); ++i) {
    try_surface(ray, static_cast<std::uint32_t>(i), nearest);
  }
}

std::optional<RayCaster::Hit> RayCaster::cast(const Vector2d& origin_m, double direction_rad,
                                              double max_m, double min_m) const {
  const Ray ray{origin_m, {std::cos(direction_rad), std::sin(direction_rad)}, min_m, max_m};
  const Vector2d origin_cells = (origin_m - lower_m_) / cell_m_;
  std::optional<Hit> nearest;
  const auto is_inside = [&](int column, int row) {
    return column >= 0 && row >= 0 && column < num_columns_ && row < num_rows_;
  };
  const bool is_near = origin_cells.x() >= 0 && origin_cells.y() >= 0 &&
                       origin_cells.x() < num_columns_ && origin_cells.y() < num_rows_;
  if (!is_near) {  // outside every surface's box: rare, so no walk to the grid
    try_all(ray, nearest);
    return nearest;
  }
  AxisWalk columns(origin_cells.x(), ray.direction.x(), cell_m_);
  AxisWalk rows(origin_cells.y(), ray.direction.y(), cell_m_);
  for (double entered_m = 0; entered_m <= max_m && is_inside(columns.cell, rows.cell);) {
    for (const std::uint32_t i : surfaces_of(columns.cell, rows.cell)) try_surface(ray, i, nearest);
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
