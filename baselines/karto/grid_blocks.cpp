#include "baselines/karto/grid_blocks.hpp"

#include <algorithm>

namespace corridor::karto {
namespace {

int blocks_for(int cells) {
  return (cells + GridBlocks::kSide_cells - 1) / GridBlocks::kSide_cells;
}

// out[k] = maximum of the values in[k + i * step] with |i| <= reach.
void widen(const std::uint8_t* in, std::uint8_t* out, std::size_t size, std::size_t step,
           int reach) {
  std::copy(in, in + size, out);
  for (int i = 1; i <= reach; ++i) {
    const std::size_t shift = step * static_cast<std::size_t>(i);
    for (std::size_t k = shift; k < size; ++k) out[k] = std::max(out[k], in[k - shift]);
    for (std::size_t k = shift; k < size; ++k) out[k - shift] = std::max(out[k - shift], in[k]);
  }
}

}  // namespace

GridBlocks::GridBlocks(int rows, int stride, int margin_cells)
    : rows_(rows), stride_(stride), margin_blocks_(blocks_for(margin_cells)) {
  const int per_row = blocks_for(stride) + 2 * margin_blocks_;
  const int per_column = blocks_for(rows) + 2 * margin_blocks_;
  layout_ = {margin_blocks_ * (per_row + 1), per_row};
  const auto count = static_cast<std::size_t>(per_row) * static_cast<std::size_t>(per_column);
  is_wanted_.resize(count);
  widened_.resize(count);
  is_drawn_.resize(count);
}

void GridBlocks::clear() {
  std::fill(is_wanted_.begin(), is_wanted_.end(), 0);
  for (const std::int32_t block : drawn_) is_drawn_[static_cast<std::size_t>(block)] = 0;
  drawn_.clear();
}

void GridBlocks::want_all() { std::fill(is_wanted_.begin() + 1, is_wanted_.end(), 1); }

void GridBlocks::want(int row, int column) {
  while (column >= stride_) {
    column -= stride_;
    ++row;
  }
  while (column < 0) {
    column += stride_;
    --row;
  }
  const int margin_cells = margin_blocks_ * kSide_cells;
  mark(row, column);
  if (column + margin_cells >= stride_) mark(row + 1, column - stride_);
  if (column < margin_cells) mark(row - 1, column + stride_);
}

// Of cells beside the grid only those within the margin matter.
void GridBlocks::mark(int row, int column) {
  const int margin_cells = margin_blocks_ * kSide_cells;
  if (row < -margin_cells || row >= rows_ + margin_cells) return;
  if (column < -margin_cells || column >= stride_ + margin_cells) return;
  is_wanted_[static_cast<std::size_t>(layout_.block_of(row, column))] = 1;
}

void GridBlocks::add_margin() {
  const auto row_step = static_cast<std::size_t>(layout_.blocks_per_row);
  widen(is_wanted_.data(), widened_.data(), widened_.size(), 1, margin_blocks_);
  widen(widened_.data(), is_wanted_.data(), is_wanted_.size(), row_step, margin_blocks_);
  is_wanted_[kNowhere] = 0;
}

}  // namespace corridor::karto
