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
  const CorrelationGrid grid({0.01, 0.3, 12, 0.03});
  EXPECT_EQ(grid.side_cells(), 2445);
  EXPECT_EQ(grid.stride(), 2448);
}

class SmallGrid : public ::testing::Test {
 protected:
  [[nodiscard]] int value(int column, int row) const {
    return grid.cells()[grid.linear_index({column, row})];
  }
  [[nodiscard]] int sum_of_all() const {
    int sum = 0;
    for (std::int32_t i = 0; i < grid.num_cells(); ++i) sum += grid.cells()[i];
    return sum;
  }

  CorrelationGrid grid{{0.05, 0.2, 1.0, 0.03}};
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
  grid.add_points(points);
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
  grid.add_points(points);
  EXPECT_EQ(sum_of_all(), 3 * (100 + 4 * 25 + 4 * 6));
  grid.reset({});
  EXPECT_EQ(sum_of_all(), 0);
}

TEST_F(SmallGrid, LeavesOutPointsBeyondTheReach) {
  grid.reset(centre_m);
  const std::vector<Eigen::Vector2d> points = {centre_m + Eigen::Vector2d(1.16, 0),
                                               centre_m + Eigen::Vector2d(0, -500)};
  grid.add_points(points);
  EXPECT_EQ(sum_of_all(), 0);
}

}  // namespace
}  // namespace corridor::karto
