#include "slam/linear/front_kernels.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "tests/slam/linear/random_blocks.hpp"

namespace corridor::linear {
namespace {

constexpr int kMaxRows = 20;      // beyond three widths of columns and two of vectors
constexpr double kTight = 1e-12;  // relative; the fronts have condition numbers below 100

using Panel = Eigen::MatrixXd;  // front_stride() rows

// A positive definite front, well conditioned.
Eigen::MatrixXd random_front(Rng& rng, int num_rows) {
  const Eigen::MatrixXd J = random_matrix(rng, num_rows, num_rows);
  return J * J.transpose() + num_rows * Eigen::MatrixXd::Identity(num_rows, num_rows);
}

// Its first columns with zeros for padding, and rubbish above the diagonal.
Panel panel_of(const Eigen::MatrixXd& front, int num_pivots) {
  Panel panel = Panel::Zero(front_stride(static_cast<int>(front.rows())), num_pivots);
  panel.topRows(front.rows()) = front.leftCols(num_pivots);
  for (int c = 0; c < num_pivots; ++c) panel.col(c).head(c).setConstant(7);
  return panel;
}

template <class Check>
void for_all_sizes(const Check& check) {
  Rng rng(11);
  for (int num_rows = 1; num_rows <= kMaxRows; ++num_rows) {
    const Eigen::MatrixXd front = random_front(rng, num_rows);
    for (int num_pivots = 1; num_pivots <= num_rows; ++num_pivots) {
      SCOPED_TRACE(testing::Message() << num_rows << " rows, " << num_pivots << " pivots");
      check(front, num_pivots);
    }
  }
}

int factorize(Panel& panel, int num_rows) {
  return factorize_panel(panel.data(), panel.rows(), num_rows, static_cast<int>(panel.cols()));
}

TEST(FrontKernels, APanelBecomesTheFirstColumnsOfTheDenseFactor) {
  for_all_sizes([](const Eigen::MatrixXd& front, int num_pivots) {
    const int num_rows = static_cast<int>(front.rows());
    Panel panel = panel_of(front, num_pivots);
    ASSERT_EQ(factorize(panel, num_rows), num_pivots);
    panel.diagonal() = panel.diagonal().cwiseInverse().eval();
    const Eigen::MatrixXd L = front.llt().matrixL();
    for (int c = 0; c < num_pivots; ++c) {
      const Eigen::VectorXd expected = L.col(c).tail(num_rows - c);
      EXPECT_LT((panel.col(c).segment(c, num_rows - c) - expected).norm(),
                kTight * expected.norm());
    }
    EXPECT_EQ(panel.bottomRows(panel.rows() - num_rows).norm(), 0);
  });
}

TEST(FrontKernels, TheUpdateIsTheSchurComplement) {
  for_all_sizes([](const Eigen::MatrixXd& front, int num_pivots) {
    const int num_rows = static_cast<int>(front.rows());
    const int num_below = num_rows - num_pivots;
    Panel panel = panel_of(front, num_pivots);
    ASSERT_EQ(factorize(panel, num_rows), num_pivots);
    Panel update = Panel::Zero(front_stride(num_below), num_below);
    update.topRows(num_below) = front.bottomRightCorner(num_below, num_below);
    subtract_outer_product(panel.data(), panel.rows(), num_rows, num_pivots, update.data(),
                           update.rows());
    const Eigen::MatrixXd corner = front.topLeftCorner(num_pivots, num_pivots);
    const Eigen::MatrixXd left = front.bottomLeftCorner(num_below, num_pivots);
    const Eigen::MatrixXd expected =
        front.bottomRightCorner(num_below, num_below) - left * corner.llt().solve(left.transpose());
    const Eigen::MatrixXd difference = update.topRows(num_below) - expected;
    EXPECT_LE(Eigen::MatrixXd(difference.triangularView<Eigen::Lower>()).norm(),
              kTight * expected.norm());
  });
}

TEST(FrontKernels, BothSubstitutionsEqualTheDenseOnes) {
  Rng rng(12);
  for_all_sizes([&rng](const Eigen::MatrixXd& front, int num_pivots) {
    const int num_rows = static_cast<int>(front.rows());
    Panel panel = panel_of(front, num_pivots);
    ASSERT_EQ(factorize(panel, num_rows), num_pivots);
    const Eigen::MatrixXd L = Eigen::MatrixXd(front.llt().matrixL()).leftCols(num_pivots);
    const auto L11 = L.topRows(num_pivots).triangularView<Eigen::Lower>();
    const auto L21 = L.bottomRows(num_rows - num_pivots);
    const Eigen::VectorXd given = random_matrix(rng, num_rows, 1);
    Eigen::VectorXd expected = given;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(panel.rows());
    x.head(num_rows) = given;
    solve_panel(panel.data(), panel.rows(), num_rows, num_pivots, x.data());
    expected.head(num_pivots) = L11.solve(given.head(num_pivots));
    expected.tail(num_rows - num_pivots) -= L21 * expected.head(num_pivots);
    EXPECT_LT((x.head(num_rows) - expected).norm(), kTight * given.norm());
    x.head(num_rows) = expected = given;
    solve_transposed_panel(panel.data(), panel.rows(), num_rows, num_pivots, x.data());
    expected.head(num_pivots) = L11.transpose().solve(
        given.head(num_pivots) - L21.transpose() * given.tail(num_rows - num_pivots));
    EXPECT_LT((x.head(num_rows) - expected).norm(), kTight * given.norm());
  });
}

TEST(FrontKernels, APanelSaysWhichPivotIsNotPositive) {
  for_all_sizes([](const Eigen::MatrixXd& front, int num_pivots) {
    for (const double bad : {-1e9, std::numeric_limits<double>::quiet_NaN()}) {
      Panel panel = panel_of(front, num_pivots);
      panel(num_pivots - 1, num_pivots - 1) = bad;
      EXPECT_EQ(factorize(panel, static_cast<int>(front.rows())), num_pivots - 1);
    }
  });
}

}  // namespace
}  // namespace corridor::linear
