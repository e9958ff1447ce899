#include "baselines/karto/correlation_grid.hpp"

#include <algorithm>
#include <cmath>

namespace corridor::karto {
namespace {

constexpr int kRowAlignment_cells = 8;

int round_up(int value, int multiple) { return (value + multiple - 1) / multiple * multiple; }

}  // namespace

int GridSpec::side_cells() const {
  return static_cast<int>(std::lround(window_m / resolution_m)) + 1 +
         2 * static_cast<int>(std::ceil(reach_m / resolution_m));
}

CorrelationGrid::CorrelationGrid(const GridSpec& spec)
    : resolution_m_(spec.resolution_m),
      side_(spec.side_cells()),
      stride_(round_up(side_, kRowAlignment_cells)),
      kernel_(spec.smear_m, spec.resolution_m),
      bytes_(static_cast<std::size_t>(num_cells()) + 2 * kMargin, 0) {}

void CorrelationGrid::reset(const Eigen::Vector2d& centre_map_m) {
  for (const std::int32_t index : stamped_) erase(index);
  stamped_.clear();
  corner_map_m_ = centre_map_m - Eigen::Vector2d::Constant(0.5 * (side_ - 1) * resolution_m_);
}

Eigen::Vector2i CorrelationGrid::cell_of(const Eigen::Vector2d& point_map_m) const {
  const Eigen::Vector2d cell = (point_map_m - corner_map_m_) / resolution_m_;
  return {static_cast<int>(std::lround(cell.x())), static_cast<int>(std::lround(cell.y()))};
}

void CorrelationGrid::add_points(std::span<const Eigen::Vector2d> points_map_m) {
  std::uint8_t* const grid = bytes_.data() + kMargin;
  for (const Eigen::Vector2d& point_m : points_map_m) {
    const Eigen::Vector2i cell = cell_of(point_m);
    if (cell.x() < 0 || cell.y() < 0 || cell.x() >= side_ || cell.y() >= side_) continue;
    const std::int32_t index = linear_index(cell);
    if (grid[index] == kOccupied) continue;
    stamped_.push_back(index);
    stamp(cell);
  }
}

void CorrelationGrid::stamp(const Eigen::Vector2i& cell) {
  const int half = kernel_.half_width;
  const bool is_inside = cell.x() >= half && cell.y() >= half && cell.x() + half < side_ &&
                         cell.y() + half < side_;
  if (is_inside) {
    stamp_inside(linear_index(cell) - half * (stride_ + 1));
  } else {
    stamp_clipped(cell);
  }
}

void CorrelationGrid::stamp_inside(std::int32_t first_index) {
  std::uint8_t* row = bytes_.data() + kMargin + first_index;
  const std::uint8_t* values = kernel_.values.data();
  for (int y = 0; y < kernel_.side; ++y, row += stride_, values += kernel_.stride) {
    for (int block = 0; block < kernel_.stride; block += SmearKernel::kBlock) {
      for (int x = block; x < block + SmearKernel::kBlock; ++x) {
        row[x] = std::max(row[x], values[x]);
      }
    }
  }
}

void CorrelationGrid::stamp_clipped(const Eigen::Vector2i& cell) {
  const int half = kernel_.half_width;
  for (int dy = -half; dy <= half; ++dy) {
    for (int dx = -half; dx <= half; ++dx) {
      const Eigen::Vector2i there = cell + Eigen::Vector2i(dx, dy);
      if ((there.array() < 0).any() || (there.array() >= side_).any()) continue;
      std::uint8_t& value = bytes_[static_cast<std::size_t>(kMargin + linear_index(there))];
      value = std::max(value, kernel_.at(dx, dy));
    }
  }
}

// Every byte a stamp may have touched lies within half_width rows and columns of its centre.
void CorrelationGrid::erase(std::int32_t centre_index) {
  const int half = kernel_.half_width;
  for (int dy = -half; dy <= half; ++dy) {
    const std::int64_t first = std::int64_t{centre_index} + std::int64_t{dy} * stride_ - half;
    const std::int64_t begin = std::max<std::int64_t>(first, 0);
    const std::int64_t end = std::min<std::int64_t>(first + kernel_.side, num_cells());
    if (begin < end) std::fill(bytes_.begin() + kMargin + begin, bytes_.begin() + kMargin + end, 0);
  }
}

}  // namespace corridor::karto
