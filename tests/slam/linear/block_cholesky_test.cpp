#include "slam/linear/block_cholesky.hpp"

#include <gtest/gtest.h>

#include "slam/linear/sparse_cholesky.hpp"
#include "tests/slam/linear/random_blocks.hpp"
#include "tests/support/allocation_counter.hpp"

namespace corridor::linear {
namespace {

using testing::kCountsAllocations;
using testing::num_allocations;

int allocations_of_a_step(LinearSolver& solver, const BlockMatrix& matrix) {
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(matrix.num_rows());
  Eigen::VectorXd x(matrix.num_rows());
  EXPECT_EQ(solver.factorize(matrix), CholeskyStatus::kOk);
  solver.solve(b, x);
  const int before = num_allocations;
  EXPECT_EQ(solver.factorize(matrix), CholeskyStatus::kOk);
  EXPECT_EQ(solver.factorize(matrix, 0.1), CholeskyStatus::kOk);
  solver.solve(b, x);
  return num_allocations - before;
}

TEST(BlockCholesky, AStepWithAnUnchangedPatternAllocatesNothing) {
  if (!kCountsAllocations) GTEST_SKIP() << "allocations cannot be counted under AddressSanitizer";
  Rng rng(3);
  for (int round = 0; round < 20; ++round) {
    const BlockMatrix matrix = random_positive_matrix(rng);
    BlockCholesky block;
    EXPECT_EQ(allocations_of_a_step(block, matrix), 0);
    SparseCholesky cholmod;  // shows that the counter counts
    EXPECT_GT(allocations_of_a_step(cholmod, matrix), 0);
  }
}

// At whichever variable they end: what waited for its parent then is forgotten.
TEST(BlockCholesky, FailedFactorisationsLeaveNothingBehind) {
  if (!kCountsAllocations) GTEST_SKIP() << "allocations cannot be counted under AddressSanitizer";
  constexpr int kWidth = 8, kNumVariables = kWidth * kWidth;
  std::vector<Pair> pairs;
  BlockMatrix matrix;
  for (int v = 0; v < kNumVariables; ++v) {
    matrix.add_variable(3);
    if (v % kWidth > 0) pairs.emplace_back(v, v - 1);
    if (v >= kWidth) pairs.emplace_back(v, v - kWidth);
  }
  for (const auto& [i, j] : pairs) matrix.slot(i, j);
  Rng rng(3);
  fill_positive(rng, pairs, 1, matrix);
  BlockCholesky solver;
  ASSERT_EQ(solver.factorize(matrix), CholeskyStatus::kOk);
  const int before = num_allocations;
  for (int round = 0; round < 30 * kNumVariables; ++round) {
    auto diagonal = matrix.block(matrix.slot(round % kNumVariables, round % kNumVariables));
    diagonal *= -1;
    ASSERT_EQ(solver.factorize(matrix), CholeskyStatus::kNotPositiveDefinite);
    diagonal *= -1;
  }
  EXPECT_EQ(num_allocations, before);
}

TEST(BlockMatrix, AnUnchangedStructureIsClearedWithoutAllocation) {
  if (!kCountsAllocations) GTEST_SKIP() << "allocations cannot be counted under AddressSanitizer";
  Rng rng(3);
  BlockMatrix matrix = random_positive_matrix(rng);
  const int before = num_allocations;
  matrix.set_zero();
  matrix.add(matrix.slot(0, 0), matrix.block(matrix.slot(0, 0)));
  EXPECT_EQ(num_allocations, before);
}

// Several trees: the updates of one must not grow into those of the next.
TEST(BlockCholesky, TheStackOfUpdatesIsAsHighAsTheWidestTreeNeeds) {
  BlockMatrix matrix;
  constexpr int kNumTrees = 50;
  std::vector<Pair> pairs;
  for (int tree = 0; tree < kNumTrees; ++tree) {
    const int first = matrix.num_variables();
    for (int v = 0; v < 30; ++v) {
      matrix.add_variable(3);
      if (v > 0) pairs.emplace_back(first + v, first + v - 1);
    }
  }
  for (const auto& [i, j] : pairs) matrix.slot(i, j);
  Rng rng(1);
  fill_positive(rng, pairs, 1, matrix);
  BlockCholesky solver;
  ASSERT_EQ(solver.factorize(matrix), CholeskyStatus::kOk);
  BlockMatrix one_tree;
  for (int v = 0; v < 30; ++v) one_tree.add_variable(3);
  for (int v = 1; v < 30; ++v) one_tree.slot(v, v - 1);
  one_tree.set_zero();
  for (int v = 0; v < 30; ++v) one_tree.block(one_tree.slot(v, v)).setIdentity();
  BlockCholesky small;
  ASSERT_EQ(small.factorize(one_tree), CholeskyStatus::kOk);
  EXPECT_LE(solver.layout().stack_size, 2 * small.layout().stack_size);
}

}  // namespace
}  // namespace corridor::linear
