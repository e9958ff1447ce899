#include "slam/linear/block_matrix.hpp"

#include <gtest/gtest.h>

namespace corridor::linear {
namespace {

TEST(BlockMatrix, WritesTheLowerTriangleOfWhatWasSummed) {
  BlockMatrix matrix;
  const int a = matrix.add_variable(2);
  const int b = matrix.add_variable(1);
  const int c = matrix.add_variable(3);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(6, 6);
  const auto fill = [&](int row, int column, double start) {
    auto block = matrix.block(matrix.slot(row, column));
    for (int j = 0; j < block.cols(); ++j) {
      for (int i = 0; i < block.rows(); ++i) {
        block(i, j) += start + i + 10 * j;
        dense(matrix.starts()[static_cast<std::size_t>(row)] + i,
              matrix.starts()[static_cast<std::size_t>(column)] + j) = block(i, j);
      }
    }
  };
  fill(c, a, 100);
  fill(a, a, 1);
  fill(b, b, 2);
  fill(c, c, 3);
  fill(c, b, 200);
  Eigen::SparseMatrix<double> lower;
  matrix.write_lower(lower);
  const Eigen::MatrixXd expected = dense.triangularView<Eigen::Lower>();
  EXPECT_EQ(Eigen::MatrixXd(lower), expected);
  EXPECT_TRUE(lower.isCompressed());
}

TEST(BlockMatrix, ASlotIsMadeOnce) {
  BlockMatrix matrix;
  matrix.add_variable(3);
  matrix.add_variable(3);
  const std::size_t slot = matrix.slot(1, 0);
  EXPECT_EQ(matrix.slot(1, 0), slot);
  EXPECT_NE(matrix.slot(1, 1), slot);
}

TEST(BlockMatrix, SetZeroKeepsTheStructure) {
  BlockMatrix matrix;
  matrix.add_variable(2);
  matrix.block(matrix.slot(0, 0)).setConstant(5);
  matrix.set_zero();
  Eigen::SparseMatrix<double> lower;
  matrix.write_lower(lower);
  EXPECT_EQ(lower.nonZeros(), 3);
  EXPECT_EQ(Eigen::MatrixXd(lower).norm(), 0);
}

}  // namespace
}  // namespace corridor::linear
