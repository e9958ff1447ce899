#include "slam/linear/sparse_cholesky.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Cholesky>
#include <vector>

#include "slam/core/rng.hpp"

namespace corridor::linear {
namespace {

struct Problem {
  Eigen::MatrixXd dense;
  Eigen::SparseMatrix<double> lower;
  std::vector<int> starts;
};

// A chain of 3-blocks with some random long links, diagonally dominant.
Problem random_problem(Rng& rng, int num_blocks) {
  Problem problem;
  const int n = 3 * num_blocks;
  problem.dense = Eigen::MatrixXd::Zero(n, n);
  const auto link = [&](int a, int b) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double value = rng.normal();
        problem.dense(3 * a + i, 3 * b + j) = value;
        problem.dense(3 * b + j, 3 * a + i) = value;
      }
    }
  };
  for (int b = 1; b < num_blocks; ++b) {
    link(b, b - 1);
    if (b > 2 && rng.uniform() < 0.3) {
      link(b, static_cast<int>(rng.below(static_cast<std::uint64_t>(b - 1))));
    }
  }
  problem.dense.diagonal().setConstant(problem.dense.cwiseAbs().rowwise().sum().maxCoeff() + 1);
  problem.lower = problem.dense.triangularView<Eigen::Lower>().toDenseMatrix().sparseView();
  problem.lower.makeCompressed();
  for (int b = 0; b <= num_blocks; ++b) problem.starts.push_back(3 * b);
  return problem;
}

RC_GTEST_PROP(SparseCholesky, SolvesLikeADenseFactorisation, (std::uint64_t seed)) {
  Rng rng(seed);
  const Problem problem = random_problem(rng, 2 + static_cast<int>(rng.below(30)));
  Eigen::MatrixXd b(problem.dense.rows(), 2);
  for (int i = 0; i < b.size(); ++i) b(i) = rng.normal();
  SparseCholesky cholesky;
  RC_ASSERT(cholesky.factorize(problem.lower, problem.starts) == CholeskyStatus::kOk);
  const Eigen::MatrixXd expected = problem.dense.llt().solve(b);
  RC_ASSERT((cholesky.solve(b) - expected).norm() <= 1e-10 * expected.norm());
}

TEST(SparseCholesky, AnalysesOncePerPattern) {
  Rng rng(3);
  Problem problem = random_problem(rng, 10);
  SparseCholesky cholesky;
  ASSERT_EQ(cholesky.factorize(problem.lower, problem.starts), CholeskyStatus::kOk);
  problem.lower *= 2;
  ASSERT_EQ(cholesky.factorize(problem.lower, problem.starts), CholeskyStatus::kOk);
  EXPECT_EQ(cholesky.num_analyses(), 1);
  const Problem other = random_problem(rng, 11);
  ASSERT_EQ(cholesky.factorize(other.lower, other.starts), CholeskyStatus::kOk);
  EXPECT_EQ(cholesky.num_analyses(), 2);
}

TEST(SparseCholesky, SaysWhenTheMatrixIsNotPositiveDefinite) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Identity(4, 4);
  dense(2, 2) = -1;
  Eigen::SparseMatrix<double> lower = dense.sparseView();
  lower.makeCompressed();
  SparseCholesky cholesky;
  const std::vector<int> starts = {0, 2, 4};
  EXPECT_EQ(cholesky.factorize(lower, starts), CholeskyStatus::kNotPositiveDefinite);
  EXPECT_EQ(cholesky.first_bad_column(), 2);
}

TEST(SparseCholesky, SaysWhenAnUnknownIsUndetermined) {
  // Two unknowns of which only the difference is known.
  Eigen::MatrixXd dense(2, 2);
  dense << 1, -1, -1, 1;
  Eigen::SparseMatrix<double> lower =
      Eigen::MatrixXd(dense.triangularView<Eigen::Lower>()).sparseView();
  lower.makeCompressed();
  SparseCholesky cholesky;
  const std::vector<int> starts = {0, 1, 2};
  EXPECT_EQ(cholesky.factorize(lower, starts), CholeskyStatus::kNotPositiveDefinite);
}

}  // namespace
}  // namespace corridor::linear
