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
      bytes_(static_cast<std::size_t>(num_cells()) + 2 * kMargin, 0),
      blocks_per_row_((stride_ >> kBlockShift_columns) + 1),
      is_drawn_(static_cast<std::size_t>(blocks_per_row_) *
                    static_cast<std::size_t>((side_ >> kBlockShift_rows) + 1),
                0) {}

void CorrelationGrid::reset(const Eigen::Vector2d& centre_map_m) {
  for (const std::int32_t block : drawn_blocks_) erase_block(block);
  drawn_blocks_.clear();
  corner_map_m_ = centre_map_m - Eigen::Vector2d::Constant(0.5 * (side_ - 1) * resolution_m_);
}

Eigen::Vector2i CorrelationGrid::cell_of(const Eigen::Vector2d& point_map_m) const {
  const Eigen::Vector2d cell = (point_map_m - corner_map_m_) / resolution_m_;
  return {round_to_cell(cell.x()), round_to_cell(cell.y())};
}

// Without branches and with all members in locals, so that it runs over four points at once.
void CorrelationGrid::find_cells(const PointColumns& points_map_m,
                                 std::vector<std::int32_t>& indices) const {
  const auto count = static_cast<std::size_t>(points_map_m.rows());
  indices.resize(count);
  const double* const x_m = points_map_m.col(0).data();
  const double* const y_m = points_map_m.col(1).data();
  const double corner_x_m = corner_map_m_.x();
  const double corner_y_m = corner_map_m_.y();
  const double resolution_m = resolution_m_;
  const std::int32_t first = border_;
  const std::int32_t end = side_ - border_;
  const std::int32_t stride = stride_;
  std::int32_t* const out = indices.data();
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t column = round_to_cell((x_m[i] - corner_x_m) / resolution_m);
    const std::int32_t row = round_to_cell((y_m[i] - corner_y_m) / resolution_m);
    const bool is_inner = (column >= first) & (column < end) & (row >= first) & (row < end);
    out[i] = is_inner ? column + row * stride : kOutside;
  }
}

void CorrelationGrid::occupy(std::span<const std::int32_t> indices) {
  const std::uint8_t* const grid = cells();
  for (const std::int32_t index : indices) {
    if (index == kOutside || grid[index] == kOccupied) continue;
    remember_block(index);
    stamp(index);
  }
}

void CorrelationGrid::stamp(std::int32_t centre_index) {
  std::uint8_t* row = bytes_.data() + kMargin + centre_index - kernel_.half_width * (stride_ + 1);
  const std::uint8_t* values = kernel_.values.data();
  for (int y = 0; y < kernel_.side; ++y, row += stride_, values += kernel_.stride) {
    for (int block = 0; block < kernel_.stride; block += SmearKernel::kBlock) {
      merge_block(row + block, values + block);
    }
  }
}

void CorrelationGrid::remember_block(std::int32_t centre_index) {
  const int row = centre_index / stride_;
  const int column = centre_index - row * stride_;
  const std::int32_t block =
      (row >> kBlockShift_rows) * blocks_per_row_ + (column >> kBlockShift_columns);
  std::uint8_t& is_drawn = is_drawn_[static_cast<std::size_t>(block)];
  if (is_drawn != 0) return;
  is_drawn = 1;
  drawn_blocks_.push_back(block);
}

// The block's cells and what the kernel reaches around them.
void CorrelationGrid::erase_block(std::int32_t block) {
  is_drawn_[static_cast<std::size_t>(block)] = 0;
  const int first_row = (block / blocks_per_row_) << kBlockShift_rows;
  const int first_column = (block % blocks_per_row_) << kBlockShift_columns;
  const int begin_row = std::max(first_row - kernel_.half_width, 0);
  const int end_row = std::min(first_row + (1 << kBlockShift_rows) + kernel_.half_width, side_);
  const int begin = std::max(first_column - kernel_.half_width, 0);
  const int end = std::min(first_column + (1 << kBlockShift_columns) + kernel_.half_width, stride_);
  std::uint8_t* const grid = bytes_.data() + kMargin;
  for (int row = begin_row; row < end_row; ++row) {
    std::memset(grid + row * stride_ + begin, 0, static_cast<std::size_t>(end - begin));
  }
}

}  // namespace corridor::karto
