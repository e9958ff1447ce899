#include "baselines/karto/correlation_grid.hpp"

#include <gtest/gtest.h>

#include "baselines/karto/smear_kernel.hpp"

namespace corridor::karto {
namespace {

TEST(SmearKernel, OfTheSequentialGridIsThirteenCellsWideWithTheGaussiansPercents) {
  const SmearKernel kernel(0.03, 0.01);
  EXPECT_EQ(kernel.half_width, 6);
  EXPECT_EQ(kernel.side, 13);
  EXPECT_EQ(kernel.at(0, 0), 100);
  EXPECT_EQ(kernel.at(1, 0), 95);   // 100 exp(-1/18) = 94.6
  EXPECT_EQ(kernel.at(0, 3), 61);   // 100 exp(-1/2) = 60.7
  EXPECT_EQ(kernel.at(3, 3), 37);   // 100 exp(-1) = 36.8
  EXPECT_EQ(kernel.at(-6, 0), 14);  // 100 exp(-2) = 13.5
  EXPECT_EQ(kernel.at(6, -6), 2);   // 100 exp(-4) = 1.8
}

TEST(SmearKernel, OfTheLoopGridIsThreeCellsWide) {
  const SmearKernel kernel(0.03, 0.05);
  EXPECT_EQ(kernel.half_width, 1);
  EXPECT_EQ(kernel.at(1, 0), 25);  // 100 exp(-25/18) = 24.9
  EXPECT_EQ(kernel.at(1, 1), 6);   // 100 exp(-25/9) = 6.2
}

TEST(CorrelationGrid, HasTheOriginalsSides) {
  EXPECT_EQ((GridSpec{0.01, 0.3, 12, 0.03}.inner_side_cells()), 2431);
  EXPECT_EQ((GridSpec{0.05, 8.0, 12, 0.03}.inner_side_cells()), 641);
  // A border of the kernel's half width + 1 on either side; rows padded to a multiple of 8.
  const CorrelationGrid grid({0.01, 0.3, 12, 0.03}, 1);
  EXPECT_EQ(grid.side_cells(), 2445);
  EXPECT_EQ(grid.stride(), 2448);
}

class SmallGrid : public ::testing::Test {
 protected:
  static constexpr int kReadMargin = 3;

  void draw(const std::vector<Eigen::Vector2d>& points_m) {
    PointColumns columns(static_cast<Eigen::Index>(points_m.size()), 2);
    for (std::size_t i = 0; i < points_m.size(); ++i) {
      columns.row(static_cast<Eigen::Index>(i)) = points_m[i].transpose();
    }
    GridCells cells;
    grid.find_cells(columns, cells);
    grid.occupy(cells, points_m.size());
  }
  void draw_all(const std::vector<Eigen::Vector2d>& points_m) {
    grid.blocks().want_all();
    draw(points_m);
  }
  [[nodiscard]] int value(int column, int row) const {
    return grid.cells()[grid.linear_index({column, row})];
  }
  [[nodiscard]] int sum_of_all() const {
    int sum = 0;
    for (std::int32_t i = 0; i < grid.num_cells(); ++i) sum += grid.cells()[i];
    return sum;
  }

  CorrelationGrid grid{{0.05, 0.2, 1.0, 0.03}, kReadMargin};
  Eigen::Vector2d centre_m{3, -2};
};

TEST_F(SmallGrid, PutsItsMiddleCellOnTheCentre) {
  grid.reset(centre_m);
  const int middle = (grid.side_cells() - 1) / 2;
  EXPECT_EQ(grid.cell_of(centre_m), Eigen::Vector2i(middle, middle));
  EXPECT_EQ(grid.cell_of(centre_m + Eigen::Vector2d(0.06, -0.16)),
            Eigen::Vector2i(middle + 1, middle - 3));
}

TEST_F(SmallGrid, SmearsEachPointAndKeepsTheLargerValueWhereStampsOverlap) {
  grid.reset(centre_m);
  const std::vector<Eigen::Vector2d> points = {centre_m, centre_m + Eigen::Vector2d(0.1, 0)};
  draw_all(points);
  const int middle = (grid.side_cells() - 1) / 2;
  EXPECT_EQ(value(middle, middle), 100);
  EXPECT_EQ(value(middle + 2, middle), 100);
  EXPECT_EQ(value(middle + 1, middle), 25);  // both say 25: the larger, not the sum
  EXPECT_EQ(value(middle + 1, middle + 1), 6);
  EXPECT_EQ(value(middle - 1, middle - 1), 6);
}

TEST_F(SmallGrid, ForgetsEverythingWhenReset) {
  grid.reset(centre_m);
  const std::vector<Eigen::Vector2d> points = {centre_m, centre_m + Eigen::Vector2d(1.1, 1.1),
                                               centre_m - Eigen::Vector2d(1.1, 1.1)};
  draw_all(points);
  EXPECT_EQ(sum_of_all(), 3 * (100 + 4 * 25 + 4 * 6));
  grid.reset({});
  EXPECT_EQ(sum_of_all(), 0);
}

TEST_F(SmallGrid, LeavesOutPointsBeyondTheReach) {
  grid.reset(centre_m);
  const std::vector<Eigen::Vector2d> points = {centre_m + Eigen::Vector2d(1.16, 0),
                                               centre_m + Eigen::Vector2d(0, -500)};
  draw_all(points);
  EXPECT_EQ(sum_of_all(), 0);
}

TEST_F(SmallGrid, DrawsAllThatIsReadWithinTheMarginOfAWantedCell) {
  for (const int offset : {-kReadMargin, 0, kReadMargin}) {
    grid.reset(centre_m);
    const std::vector<Eigen::Vector2d> points = {centre_m};
    // The cell beside the point's own is smeared; it is read from `offset` cells further on.
    const Eigen::Vector2i smeared = grid.cell_of(centre_m) + Eigen::Vector2i(1, 0);
    grid.blocks().want(smeared.y(), smeared.x() + offset);
    grid.blocks().add_margin();
    draw(points);
    EXPECT_EQ(value(smeared.x(), smeared.y()), 25) << offset;
  }
}

TEST_F(SmallGrid, LeavesOutWhatNobodyReads) {
  CorrelationGrid wide({0.01, 0.2, 1.0, 0.03}, kReadMargin);
  wide.reset(centre_m);
  wide.blocks().want(wide.middle_cell(), wide.middle_cell());
  wide.blocks().add_margin();
  PointColumns points(2, 2);
  points << centre_m.x(), centre_m.y(), centre_m.x() + 0.6, centre_m.y();
  GridCells cells;
  wide.find_cells(points, cells);
  wide.occupy(cells, 2);
  EXPECT_EQ(wide.cells()[cells.index[0]], 100);
  EXPECT_EQ(wide.cells()[cells.index[1]], 0);
}

TEST(GridBlocks, ACellBeyondTheEndOfARowIsOneOfTheNextRow) {
  GridBlocks blocks(200, 208, 1);
  blocks.want(100, 208 + 50);
  EXPECT_TRUE(blocks.is_wanted(blocks.layout().block_of(101, 50)));
  EXPECT_FALSE(blocks.is_wanted(blocks.layout().block_of(100, 50 + 16)));
  blocks.clear();
  blocks.want(100, -50);
  EXPECT_TRUE(blocks.is_wanted(blocks.layout().block_of(99, 208 - 50)));
}

TEST(GridBlocks, TheMarginRunsAroundTheEndsOfRows) {
  GridBlocks blocks(200, 208, 10);
  blocks.want(100, 205);
  blocks.add_margin();
  EXPECT_TRUE(blocks.is_wanted(blocks.layout().block_of(100, 195)));
  EXPECT_TRUE(blocks.is_wanted(blocks.layout().block_of(101, 6)));
  blocks.clear();
  blocks.want(100, 2);
  blocks.add_margin();
  EXPECT_TRUE(blocks.is_wanted(blocks.layout().block_of(99, 208 - 8)));
}

TEST(GridBlocks, NowhereIsNeverWanted) {
  GridBlocks blocks(64, 64, 16);
  blocks.want_all();
  EXPECT_FALSE(blocks.is_wanted(GridBlocks::kNowhere));
  blocks.clear();
  blocks.want(-16, -16);
  blocks.add_margin();
  EXPECT_FALSE(blocks.is_wanted(GridBlocks::kNowhere));
}

}  // namespace
}  // namespace corridor::karto
