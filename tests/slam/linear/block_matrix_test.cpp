#include "slam/linear/block_matrix.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>

#include "tests/slam/linear/random_blocks.hpp"

namespace corridor::linear {
namespace {

// Sums random numbers into every block, and into a dense matrix at the rows that starts() says.
Eigen::MatrixXd fill(Rng& rng, const std::map<Pair, std::size_t>& slots, BlockMatrix& matrix) {
  matrix.set_zero();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(matrix.num_rows(), matrix.num_rows());
  for (const auto& [pair, slot] : slots) {
    const auto block = matrix.block(slot);
    const Eigen::MatrixXd summand = random_matrix(rng, block.rows(), block.cols());
    matrix.add(slot, summand);
    matrix.block(slot) += summand;
    dense.block(matrix.starts()[static_cast<std::size_t>(pair.first)],
                matrix.starts()[static_cast<std::size_t>(pair.second)], block.rows(),
                block.cols()) = 2 * summand;
  }
  return dense;
}

RC_GTEST_PROP(BlockMatrix, ScalarsAreWhatWasSummedWhileTheStructureGrows, (std::uint64_t seed)) {
  Rng rng(seed);
  BlockMatrix matrix;
  std::map<Pair, std::size_t> slots;
  for (int round = 0; round < 4; ++round) {
    for (const int dimension : random_dimensions(rng, 1 + below(rng, 6))) {
      const int v = matrix.add_variable(dimension);
      slots[{v, v}] = matrix.slot(v, v);
    }
    for (const auto& [i, j] : random_pairs(rng, matrix.num_variables())) {
      slots[{i, j}] = matrix.slot(i, j);
    }
    // Numbers given in earlier rounds still stand.
    for (const auto& [pair, slot] : slots) RC_ASSERT(matrix.slot(pair.first, pair.second) == slot);
    const Eigen::MatrixXd dense = fill(rng, slots, matrix);
    RC_ASSERT(Eigen::MatrixXd(matrix.scalars()) == dense);
    RC_ASSERT(matrix.scalars().isCompressed());
    for (const auto& [pair, slot] : slots) {
      const auto of = matrix.pattern().of(pair.second);
      RC_ASSERT(pair.first == pair.second || std::binary_search(of.begin(), of.end(), pair.first));
    }
    RC_ASSERT(matrix.pattern().rows.size() + static_cast<std::size_t>(matrix.num_variables()) ==
              slots.size());
  }
}

TEST(BlockMatrix, AddsBlocksOfConstantSize) {
  BlockMatrix matrix;
  matrix.add_variable(2);
  matrix.add_variable(3);
  const std::size_t slot = matrix.slot(1, 0);
  matrix.set_zero();
  Eigen::Matrix<double, 3, 2> summand;
  summand << 1, 2, 3, 4, 5, 6;
  matrix.add(slot, summand);
  matrix.add(slot, 2 * summand);
  EXPECT_EQ(matrix.block(slot), 3 * summand);
}

TEST(BlockMatrix, AddsARowOfConstantSizeAcrossTheColumns) {
  BlockMatrix matrix;
  matrix.add_variable(3);
  matrix.add_variable(1);
  matrix.add_variable(2);
  const std::size_t slot = matrix.slot(1, 0);
  matrix.slot(2, 0);
  matrix.set_zero();
  matrix.add(slot, Eigen::RowVector3d(4, 5, 6));
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(6, 6);
  expected.row(3).head<3>() << 4, 5, 6;
  EXPECT_EQ(Eigen::MatrixXd(matrix.scalars()), expected);
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
  matrix.set_zero();
  matrix.block(matrix.slot(0, 0)).setConstant(5);
  matrix.set_zero();
  EXPECT_EQ(matrix.scalars().nonZeros(), 4);
  EXPECT_EQ(Eigen::MatrixXd(matrix.scalars()).norm(), 0);
}

TEST(BlockMatrixDeathTest, ValuesAreOutOfReachUntilANewStructureIsCleared) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  BlockMatrix matrix;
  matrix.add_variable(2);
  matrix.set_zero();
  const std::size_t slot = matrix.slot(0, 0);
  matrix.add_variable(1);
  EXPECT_DEATH((void)matrix.block(slot), "contract broken");
  EXPECT_DEATH((void)matrix.scalars(), "contract broken");
  matrix.set_zero();
  EXPECT_EQ(matrix.block(slot).norm(), 0);
}

}  // namespace
}  // namespace corridor::linear
