// Blocks of a correlation grid: which of them a search may read, and which hold something. What no
// search reads need not be drawn, and what was not drawn need not be erased.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace corridor::karto {

// A grid of rows of `stride` cells in one piece of memory, of which a reader may run from the end
// of one row into the next: a cell beyond the end of a row is one of the row above.
class GridBlocks {
 public:
  static constexpr int kShift = 4;
  static constexpr int kSide_cells = 1 << kShift;

  // What is read lies at most `margin_cells` from a wanted cell, along rows and columns.
  GridBlocks(int rows, int stride, int margin_cells);

  // Wants nothing and holds nothing.
  void clear();
  void want_all();
  // Marks one cell that is read around. Any row and column; columns run on into other rows.
  void want(int row, int column);
  // To be called after the last want(): the margin is wanted as well.
  void add_margin();

  // Where the blocks of cells are; small, to be copied into a loop.
  struct Layout {
    std::int32_t first_block = 0;  // of the grid's first cell
    std::int32_t blocks_per_row = 0;

    [[nodiscard]] std::int32_t block_of(int row, int column) const {
      return first_block + (row >> kShift) * blocks_per_row + (column >> kShift);
    }
  };
  [[nodiscard]] const Layout& layout() const { return layout_; }
  // Stands for cells that are never drawn.
  static constexpr std::int32_t kNowhere = 0;
  [[nodiscard]] bool is_wanted(std::int32_t block) const {
    return is_wanted_[static_cast<std::size_t>(block)] != 0;
  }

  // One a block, 1 where wanted.
  [[nodiscard]] const std::vector<std::uint8_t>& wanted() const { return is_wanted_; }

  // Remembers that the block holds something.
  void draw(std::int32_t block) {
    std::uint8_t& is_drawn = is_drawn_[static_cast<std::size_t>(block)];
    if (is_drawn != 0) return;
    is_drawn = 1;
    drawn_.push_back(block);
  }
  [[nodiscard]] const std::vector<std::int32_t>& drawn() const { return drawn_; }
  // Lower left cell (column, row) of a block of the grid.
  [[nodiscard]] Eigen::Vector2i first_cell(std::int32_t block) const {
    const std::int32_t in_grid = block - layout_.first_block;
    return {(in_grid % layout_.blocks_per_row) << kShift, (in_grid / layout_.blocks_per_row)
                                                              << kShift};
  }

 private:
  void mark(int row, int column);

  int rows_;
  int stride_;
  int margin_blocks_;
  Layout layout_;  // of the grid with a margin on all sides; block 0 is in the margin's corner
  std::vector<std::uint8_t> is_wanted_;
  std::vector<std::uint8_t> widened_;  // scratch of add_margin
  std::vector<std::uint8_t> is_drawn_;
  std::vector<std::int32_t> drawn_;
};

}  // namespace corridor::karto
