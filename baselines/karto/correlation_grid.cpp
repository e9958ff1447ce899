#include "baselines/karto/correlation_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "baselines/karto/round_cells.hpp"

namespace corridor::karto {
namespace {

constexpr int kRowAlignment_cells = 8;
constexpr int kErasedAtOnce = 32;
static_assert(kErasedAtOnce <= CorrelationGrid::kMargin);

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

// What reads a cell reads what was stamped around others.
CorrelationGrid::CorrelationGrid(const GridSpec& spec, int read_margin_cells)
    : resolution_m_(spec.resolution_m),
      kernel_(spec.smear_m, spec.resolution_m),
      border_(kernel_.half_width + 1),
      side_(spec.inner_side_cells() + 2 * border_),
      stride_(round_up(side_, kRowAlignment_cells)),
      bytes_(static_cast<std::size_t>(num_cells()) + 2 * kMargin, 0),
      blocks_(side_, stride_, read_margin_cells + kernel_.half_width) {}

void CorrelationGrid::reset(const Eigen::Vector2d& centre_map_m) {
  for (const std::int32_t block : blocks_.drawn()) erase_block(block);
  blocks_.clear();
  corner_map_m_ = centre_map_m - Eigen::Vector2d::Constant(0.5 * (side_ - 1) * resolution_m_);
}

Eigen::Vector2i CorrelationGrid::cell_of(const Eigen::Vector2d& point_map_m) const {
  const Eigen::Vector2d cell = (point_map_m - corner_map_m_) / resolution_m_;
  return {round_to_cell(cell.x()), round_to_cell(cell.y())};
}

// Without branches and with all members in locals, so that it runs over four points at once.
void CorrelationGrid::find_cells(const PointColumns& points_map_m, GridCells& cells) const {
  const auto count = static_cast<std::size_t>(points_map_m.rows());
  cells.resize(count);
  const double* const x_m = points_map_m.col(0).data();
  const double* const y_m = points_map_m.col(1).data();
  const double corner_x_m = corner_map_m_.x();
  const double corner_y_m = corner_map_m_.y();
  const double resolution_m = resolution_m_;
  const std::int32_t first = border_;
  const std::int32_t end = side_ - border_;
  const std::int32_t stride = stride_;
  const GridBlocks::Layout layout = blocks_.layout();
  std::int32_t* const index = cells.index.data();
  std::int32_t* const block = cells.block.data();
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t column = round_to_cell((x_m[i] - corner_x_m) / resolution_m);
    const std::int32_t row = round_to_cell((y_m[i] - corner_y_m) / resolution_m);
    const bool is_inner = (column >= first) & (column < end) & (row >= first) & (row < end);
    index[i] = is_inner ? column + row * stride : 0;
    block[i] = is_inner ? layout.block_of(row, column) : GridBlocks::kNowhere;
  }
}

void CorrelationGrid::occupy(const GridCells& found, std::size_t count) {
  const std::uint8_t* const grid = cells();
  for (std::size_t i = 0; i < count; ++i) {
    if (!blocks_.is_wanted(found.block[i]) || grid[found.index[i]] == kOccupied) continue;
    blocks_.draw(found.block[i]);
    stamp(found.index[i]);
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

// The block's cells and what the kernel reaches around them, in whole chunks: a few cells more are
// erased, or will be, with their own block.
void CorrelationGrid::erase_block(std::int32_t block) {
  const Eigen::Vector2i first = blocks_.first_cell(block);
  const int reach = kernel_.half_width;
  const int end_row = std::min(first.y() + GridBlocks::kSide_cells + reach, side_);
  const int begin = std::max(first.x() - reach, 0);
  const int end = std::min(first.x() + GridBlocks::kSide_cells + reach, stride_);
  for (int row = std::max(first.y() - reach, 0); row < end_row; ++row) {
    std::uint8_t* const row_cells = bytes_.data() + kMargin + row * stride_;
    for (int column = begin; column < end; column += kErasedAtOnce) {
      std::memset(row_cells + column, 0, kErasedAtOnce);
    }
  }
}

}  // namespace corridor::karto
