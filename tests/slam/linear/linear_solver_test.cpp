// Laws that every linear solver keeps: CHOLMOD's both methods and our own.
#include "slam/linear/linear_solver.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <memory>

#include "slam/linear/block_cholesky.hpp"
#include "slam/linear/make_linear_solver.hpp"
#include "slam/linear/sparse_cholesky.hpp"
#include "tests/slam/linear/random_blocks.hpp"

namespace corridor::linear {
namespace {

using Solvers = std::vector<std::unique_ptr<LinearSolver>>;

// Solutions of the matrices here, whose condition numbers are below 1e5.
constexpr double kTight = 1e-9;

Solvers all_solvers() {
  Solvers solvers;
  solvers.push_back(std::make_unique<SparseCholesky>(CholmodMethod::kSimplicial));
  solvers.push_back(std::make_unique<SparseCholesky>(CholmodMethod::kSupernodal));
  solvers.push_back(std::make_unique<BlockCholesky>());
  return solvers;
}

Eigen::MatrixXd solution_of(LinearSolver& solver, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd x(b.rows(), b.cols());
  solver.solve(b, x);
  return x;
}

// Two variables of which the factors know the difference only, and `prior` times the identity.
BlockMatrix known_up_to_a_shift(double prior) {
  BlockMatrix matrix;
  matrix.add_variable(2);
  matrix.add_variable(2);
  const std::size_t slot = matrix.slot(1, 0);
  matrix.set_zero();
  matrix.add(slot, -Eigen::Matrix2d::Identity());
  for (int v = 0; v < 2; ++v) {
    matrix.add(matrix.slot(v, v), Eigen::Matrix2d((1 + prior) * Eigen::Matrix2d::Identity()));
  }
  return matrix;
}

RC_GTEST_PROP(LinearSolver, SolvesLikeADenseFactorisation, (std::uint64_t seed)) {
  Rng rng(seed);
  const BlockMatrix matrix = random_positive_matrix(rng);
  const Eigen::MatrixXd b = random_matrix(rng, matrix.num_rows(), 2);
  const Eigen::MatrixXd expected = to_dense(matrix).ldlt().solve(b);
  for (const auto& solver : all_solvers()) {
    RC_ASSERT(solver->factorize(matrix) == CholeskyStatus::kOk);
    RC_ASSERT((solution_of(*solver, b) - expected).norm() <= kTight * expected.norm());
    RC_ASSERT(solver->first_bad_variable() == -1);
  }
}

RC_GTEST_PROP(LinearSolver, DampingScalesTheDiagonal, (std::uint64_t seed, bool is_weak)) {
  Rng rng(seed);
  const BlockMatrix matrix = random_positive_matrix(rng);
  const double damping = is_weak ? 1e-3 : 5;
  Eigen::MatrixXd dense = to_dense(matrix);
  dense.diagonal() *= 1 + damping;
  const Eigen::VectorXd b = random_matrix(rng, matrix.num_rows(), 1);
  const Eigen::VectorXd expected = dense.ldlt().solve(b);
  for (const auto& solver : all_solvers()) {
    RC_ASSERT(solver->factorize(matrix, damping) == CholeskyStatus::kOk);
    RC_ASSERT((solution_of(*solver, b) - expected).norm() <= kTight * expected.norm());
  }
}

RC_GTEST_PROP(LinearSolver, TheUpperTriangleOfADiagonalBlockIsNotUsed, (std::uint64_t seed)) {
  Rng rng(seed);
  BlockMatrix matrix = random_positive_matrix(rng);
  const Eigen::VectorXd b = random_matrix(rng, matrix.num_rows(), 1);
  const Eigen::VectorXd expected = to_dense(matrix).ldlt().solve(b);
  for (int v = 0; v < matrix.num_variables(); ++v) {
    auto block = matrix.block(matrix.slot(v, v));
    for (int c = 0; c < block.cols(); ++c) block.col(c).head(c).setConstant(1e6);
  }
  for (const auto& solver : all_solvers()) {
    RC_ASSERT(solver->factorize(matrix) == CholeskyStatus::kOk);
    RC_ASSERT((solution_of(*solver, b) - expected).norm() <= kTight * expected.norm());
  }
}

// Whatever happened before, a failed factorisation included.
RC_GTEST_PROP(LinearSolver, ARepeatedFactorisationEqualsAFreshOneBitForBit, (std::uint64_t seed)) {
  Rng rng(seed);
  const int num_variables = 1 + below(rng, 30);
  const std::vector<Pair> pairs = random_pairs(rng, num_variables);
  BlockMatrix matrix = make_structure(rng, random_dimensions(rng, num_variables), pairs);
  Solvers solvers = all_solvers();
  Solvers fresh_solvers = all_solvers();
  for (const double prior : {1.0, -1e9, 3.0}) {
    fill_positive(rng, pairs, prior, matrix);
    for (const auto& solver : solvers) {
      const auto expected = prior > 0 ? CholeskyStatus::kOk : CholeskyStatus::kNotPositiveDefinite;
      RC_ASSERT(solver->factorize(matrix) == expected);
      RC_ASSERT((solver->first_bad_variable() == -1) == (prior > 0));
    }
  }
  const Eigen::VectorXd b = random_matrix(rng, matrix.num_rows(), 1);
  for (std::size_t s = 0; s < solvers.size(); ++s) {
    RC_ASSERT(fresh_solvers[s]->factorize(matrix) == CholeskyStatus::kOk);
    RC_ASSERT(solution_of(*solvers[s], b) == solution_of(*fresh_solvers[s], b));
    RC_ASSERT(solvers[s]->num_analyses() == 1);
  }
}

RC_GTEST_PROP(LinearSolver, FollowsAStructureThatGrows, (std::uint64_t seed)) {
  Rng rng(seed);
  BlockMatrix matrix;
  Solvers solvers = all_solvers();
  std::vector<Pair> pairs;
  for (int round = 1; round <= 3; ++round) {
    for (const int dimension : random_dimensions(rng, 1 + below(rng, 8))) {
      matrix.add_variable(dimension);
    }
    for (const auto& pair : random_pairs(rng, matrix.num_variables())) {
      matrix.slot(pair.first, pair.second);
      pairs.push_back(pair);
    }
    fill_positive(rng, pairs, 1.0, matrix);
    const Eigen::VectorXd b = random_matrix(rng, matrix.num_rows(), 1);
    const Eigen::VectorXd expected = to_dense(matrix).ldlt().solve(b);
    for (const auto& solver : solvers) {
      RC_ASSERT(solver->factorize(matrix) == CholeskyStatus::kOk);
      RC_ASSERT((solution_of(*solver, b) - expected).norm() <= kTight * expected.norm());
      RC_ASSERT(solver->num_analyses() == round);
    }
  }
}

// Same number of variables, rows and pairs: only the pairs differ.
TEST(LinearSolver, APatternOfTheSameSizeIsAnalysedAnew) {
  const auto make = [](int tip) {
    BlockMatrix matrix;
    for (int v = 0; v < 3; ++v) matrix.add_variable(1);
    const std::size_t slot = matrix.slot(tip, 0);
    matrix.set_zero();
    matrix.block(slot)(0, 0) = 1;
    for (int v = 0; v < 3; ++v) matrix.block(matrix.slot(v, v))(0, 0) = 2;
    return matrix;
  };
  const Eigen::Vector3d b(1, 2, 3);
  for (const auto& solver : all_solvers()) {
    for (const int tip : {1, 2}) {
      const BlockMatrix matrix = make(tip);
      ASSERT_EQ(solver->factorize(matrix), CholeskyStatus::kOk);
      EXPECT_LT((to_dense(matrix) * solution_of(*solver, b) - b).norm(), kTight);
    }
    EXPECT_EQ(solver->num_analyses(), 2);
  }
}

TEST(LinearSolver, TheSamePairsOfOtherDimensionsAreAnalysedAnew) {
  for (const auto& solver : all_solvers()) {
    for (const int dimension : {1, 3, 2}) {
      BlockMatrix matrix;
      for (int v = 0; v < 2; ++v) matrix.add_variable(dimension);
      matrix.slot(1, 0);
      Rng rng(1);
      fill_positive(rng, {{1, 0}}, 1, matrix);
      const Eigen::VectorXd b = Eigen::VectorXd::Ones(matrix.num_rows());
      ASSERT_EQ(solver->factorize(matrix), CholeskyStatus::kOk);
      EXPECT_LT((to_dense(matrix) * solution_of(*solver, b) - b).norm(), kTight);
    }
    EXPECT_EQ(solver->num_analyses(), 3);
  }
}

// Slots of the same pairs, made in another order: the same pattern, and the same factor.
TEST(LinearSolver, TheOrderInWhichSlotsWereMadeDoesNotMatter) {
  const std::vector<Pair> pairs = {{1, 0}, {2, 0}, {2, 1}, {3, 2}};
  const std::vector<Pair> reversed(pairs.rbegin(), pairs.rend());
  const auto make = [](const std::vector<Pair>& slots) {
    BlockMatrix matrix;
    for (const int dimension : {2, 3, 1, 2}) matrix.add_variable(dimension);
    for (const auto& [i, j] : slots) matrix.slot(i, j);
    return matrix;
  };
  for (const auto& solver : all_solvers()) {
    BlockMatrix one = make(pairs), other = make(reversed);
    Rng rng(1), same_rng(1);
    fill_positive(rng, pairs, 1, one);
    fill_positive(same_rng, pairs, 1, other);
    const Eigen::VectorXd b = Eigen::VectorXd::Ones(one.num_rows());
    ASSERT_EQ(solver->factorize(one), CholeskyStatus::kOk);
    const Eigen::MatrixXd expected = solution_of(*solver, b);
    ASSERT_EQ(solver->factorize(other), CholeskyStatus::kOk);
    EXPECT_EQ(solution_of(*solver, b), expected);
    EXPECT_EQ(solver->num_analyses(), 1);
  }
}

TEST(LinearSolver, TheSolutionMayTakeThePlaceOfTheRightSide) {
  Rng rng(4);
  const BlockMatrix matrix = random_positive_matrix(rng);
  for (const auto& solver : all_solvers()) {
    ASSERT_EQ(solver->factorize(matrix), CholeskyStatus::kOk);
    Eigen::VectorXd b = Eigen::VectorXd::Ones(matrix.num_rows());
    const Eigen::MatrixXd expected = solution_of(*solver, b);
    solver->solve(b, b);
    EXPECT_EQ(b, expected);
  }
}

// A variable without neighbours that alone is at fault: every solver names it, wherever it stands.
RC_GTEST_PROP(LinearSolver, NamesTheVariableAtFault, (std::uint64_t seed)) {
  Rng rng(seed);
  BlockMatrix matrix = random_positive_matrix(rng);
  const int lonely = matrix.add_variable(3);
  const int last = matrix.add_variable(1);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double value : {0.0, -1.0, 1e-30, kInfinity, kNan}) {
    matrix.set_zero();
    for (int v = 0; v <= last; ++v) matrix.block(matrix.slot(v, v)).setIdentity();
    matrix.block(matrix.slot(lonely, lonely))(1, 1) = value;
    for (const auto& solver : all_solvers()) {
      RC_ASSERT(solver->factorize(matrix) == CholeskyStatus::kNotPositiveDefinite);
      RC_ASSERT(solver->first_bad_variable() == lonely);
    }
  }
}

RC_GTEST_PROP(LinearSolver, NotANumberAnywhereIsAStatus, (std::uint64_t seed)) {
  Rng rng(seed);
  BlockMatrix matrix = random_positive_matrix(rng);
  const int column = below(rng, matrix.num_variables());
  const auto of = matrix.pattern().of(column);
  const int row = of.empty() ? column : of[static_cast<std::size_t>(below(rng, 1000)) % of.size()];
  matrix.block(matrix.slot(row, column))(0, 0) = std::numeric_limits<double>::quiet_NaN();
  for (const auto& solver : all_solvers()) {
    RC_ASSERT(solver->factorize(matrix) == CholeskyStatus::kNotPositiveDefinite);
    RC_ASSERT(solver->first_bad_variable() >= 0);
  }
}

// Nothing says where a group of variables is that knows nothing of the others.
TEST(LinearSolver, NamesOneOfTheVariablesThatAreUndetermined) {
  Rng rng(2);
  BlockMatrix matrix = known_up_to_a_shift(0);
  const int settled = matrix.add_variable(2);
  matrix.set_zero();
  const Eigen::Matrix2d J = random_matrix(rng, 2, 2);
  matrix.add(matrix.slot(0, 0), J.transpose() * J);
  matrix.add(matrix.slot(1, 1), J.transpose() * J);
  matrix.add(matrix.slot(1, 0), -J.transpose() * J);
  matrix.add(matrix.slot(settled, settled), Eigen::Matrix2d::Identity());
  for (const auto& solver : all_solvers()) {
    EXPECT_EQ(solver->factorize(matrix), CholeskyStatus::kNotPositiveDefinite);
    EXPECT_GE(solver->first_bad_variable(), 0);
    EXPECT_LT(solver->first_bad_variable(), settled);
  }
}

// The limit is a reciprocal condition of the factor of 1e-15. Here it is about twice the prior.
TEST(LinearSolver, AllRefuseTheSameNearlySingularMatrices) {
  for (const auto& solver : all_solvers()) {
    for (const double prior : {1e-3, 1e-9, 1e-13, 1e-14}) {
      EXPECT_EQ(solver->factorize(known_up_to_a_shift(prior)), CholeskyStatus::kOk) << prior;
    }
    for (const double prior : {2e-16, 1e-20, 0.0, -1e-14}) {
      EXPECT_EQ(solver->factorize(known_up_to_a_shift(prior)), CholeskyStatus::kNotPositiveDefinite)
          << prior;
    }
  }
}

// A variable far weaker than the others, by random powers of ten: away from the limit by a
// factor of 10 either way all solvers give the same answer, and name that variable.
RC_GTEST_PROP(LinearSolver, AllRefuseTheSameBadlyScaledMatrices, (std::uint64_t seed)) {
  Rng rng(seed);
  BlockMatrix matrix = random_positive_matrix(rng);
  const int weak = matrix.add_variable(1 + below(rng, 5));
  matrix.set_zero();
  const double weight = std::pow(10, -20 * rng.uniform());
  for (int v = 0; v <= weak; ++v) {
    auto block = matrix.block(matrix.slot(v, v));
    block.setIdentity();
    if (v == weak) block *= weight;
  }
  RC_PRE(weight < 1e-16 || weight > 1e-14);
  for (const auto& solver : all_solvers()) {
    const bool is_ok = solver->factorize(matrix) == CholeskyStatus::kOk;
    RC_ASSERT(is_ok == (weight > 1e-14));
    RC_ASSERT(solver->first_bad_variable() == (is_ok ? -1 : weak));
  }
}

TEST(LinearSolver, CountsTheFactorOfADenseMatrix) {
  BlockMatrix matrix;
  for (int v = 0; v < 4; ++v) matrix.add_variable(3);
  std::vector<Pair> pairs;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) pairs.emplace_back(i, j);
  }
  for (const auto& [i, j] : pairs) matrix.slot(i, j);
  Rng rng(1);
  fill_positive(rng, pairs, 1, matrix);
  for (const auto& solver : all_solvers()) {
    ASSERT_EQ(solver->factorize(matrix), CholeskyStatus::kOk);
    EXPECT_EQ(solver->num_factor_nonzeros(), 12 * 13 / 2);
    EXPECT_NEAR(solver->num_flops(), 12 * 12 * 12 / 3.0, 12 * 12);
  }
}

RC_GTEST_PROP(LinearSolver, OnlyOurOwnFillsInZeros, (std::uint64_t seed)) {
  Rng rng(seed);
  const BlockMatrix matrix = random_positive_matrix(rng);
  const Solvers solvers = all_solvers();
  for (const auto& solver : solvers) RC_ASSERT(solver->factorize(matrix) == CholeskyStatus::kOk);
  RC_ASSERT(solvers[0]->num_factor_nonzeros() == solvers[1]->num_factor_nonzeros());
  RC_ASSERT(solvers[2]->num_factor_nonzeros() >= solvers[0]->num_factor_nonzeros());
}

TEST(LinearSolver, IsMadeByKind) {
  EXPECT_EQ(to_text(LinearSolverKind::kCholmod), "cholmod");
  EXPECT_EQ(to_text(LinearSolverKind::kBlock), "block");
  EXPECT_EQ(to_text(CholeskyStatus::kNotPositiveDefinite), "not_positive_definite");
  for (const auto kind : {LinearSolverKind::kCholmod, LinearSolverKind::kBlock}) {
    EXPECT_EQ(make_linear_solver(kind)->name(), to_text(kind));
  }
}

TEST(LinearSolverDeathTest, WithoutAGoodFactorThereIsNoSolution) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  for (const auto& solver : all_solvers()) {
    Eigen::VectorXd x = Eigen::VectorXd::Ones(4);
    EXPECT_DEATH(solver->solve(x, x), "contract broken");
    ASSERT_EQ(solver->factorize(known_up_to_a_shift(1)), CholeskyStatus::kOk);
    ASSERT_NE(solver->factorize(known_up_to_a_shift(-9)), CholeskyStatus::kOk);
    EXPECT_DEATH(solver->solve(x, x), "contract broken");
  }
}

}  // namespace
}  // namespace corridor::linear
