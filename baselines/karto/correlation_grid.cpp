#include "baselines/karto/correlation_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "baselines/karto/round_cells.hpp"

namespace corridor::karto {
namespace {

constexpr int kRowAlignment_cells = 8;

int round_up(int value, int multiple) { return (value + multiple - 1) / multiple * multiple; }

// Copies in and out tell the compiler that the two do not overlap: one vector maximum.
void merge_block(std::uint8_t* cells, const std::uint8_t* values) {
  std::array<std::uint8_t, SmearKernel::kBlock> merged;
  std::array<std::uint8_t, SmearKernel::kBlock> stamp;
  std::memcpy(merged.data(), cells, merged.size());
  std::memcpy(stamp.data(), values, stamp.size());
  for (std::size_t i = 0; i < merged.size(); ++i) merged[i] = std::max(merged[i], stamp[i]);
  std::memcpy(cells, merged.data(), merged.size());
}

}  // namespace

int GridSpec::inner_side_cells() const {
  return static_cast<int>(std::lround(window_m / resolution_m)) + 1 +
         2 * static_cast<int>(std::ceil(reach_m / resolution_m));
}

CorrelationGrid::CorrelationGrid(const GridSpec& spec)
    : resolution_m_(spec.resolution_m),
      kernel_(spec.smear_m, spec.resolution_m),
      border_(kernel_.half_width + 1),
      side_(spec.inner_side_cells() + 2 * border_),
      stride_(round_up(side_, kRowAlignment_cells)),
      bytes_(static_cast<std::size_t>(num_cells()) + 2 * kMargin, 0) {}

void CorrelationGrid::reset(const Eigen::Vector2d& centre_map_m) {
  for (const std::int32_t index : stamped_) erase(index);
  stamped_.clear();
  corner_map_m_ = centre_map_m - Eigen::Vector2d::Constant(0.5 * (side_ - 1) * resolution_m_);
}

Eigen::Vector2i CorrelationGrid::cell_of(const Eigen::Vector2d& point_map_m) const {
  const Eigen::Vector2d cell = (point_map_m - corner_map_m_) / resolution_m_;
  return {round_to_cell(cell.x()), round_to_cell(cell.y())};
}

void CorrelationGrid::add_points(std::span<const Eigen::Vector2d> points_map_m) {
  std::uint8_t* const grid = bytes_.data() + kMargin;
  for (const Eigen::Vector2d& point_m : points_map_m) {
    const Eigen::Vector2i cell = cell_of(point_m);
    const bool is_inner = (cell.array() >= border_).all() && (cell.array() < side_ - border_).all();
    if (!is_inner) continue;
    const std::int32_t index = linear_index(cell);
    if (grid[index] == kOccupied) continue;
    stamped_.push_back(index);
    stamp(index);
  }
}

void CorrelationGrid::stamp(std::int32_t centre_index) {
  std::uint8_t* row = bytes_.data() + kMargin + first_of_stamp(centre_index);
  const std::uint8_t* values = kernel_.values.data();
  for (int y = 0; y < kernel_.side; ++y, row += stride_, values += kernel_.stride) {
    for (int block = 0; block < kernel_.stride; block += SmearKernel::kBlock) {
      merge_block(row + block, values + block);
    }
  }
}

// Whole blocks: what lies beside the stamp is erased as well, sooner or later.
void CorrelationGrid::erase(std::int32_t centre_index) {
  std::uint8_t* row = bytes_.data() + kMargin + first_of_stamp(centre_index);
  for (int y = 0; y < kernel_.side; ++y, row += stride_) {
    for (int block = 0; block < kernel_.stride; block += SmearKernel::kBlock) {
      std::memset(row + block, 0, SmearKernel::kBlock);
    }
  }
}

}  // namespace corridor::karto
