#include "slam/fusion/loop_edges.hpp"

#include <gtest/gtest.h>

#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/graph/factors/pose_factors.hpp"

namespace corridor::fusion {
namespace {

constexpr double kGate = 30;

// Key scans 0 to 10, a metre apart on the x axis; odometry between them is good to 5 cm.
class LoopEdgesTest : public ::testing::Test {
 protected:
  LoopEdgesTest() {
    std::vector<graph::FactorPtr> factors;
    graph::Values values;
    factors.push_back(std::make_unique<graph::PosePrior>(graph::pose_key(0), Pose2(),
                                                         Eigen::Matrix3d::Identity() / 1e-4));
    values.set_pose(0, Pose2());
    for (std::uint32_t k = 1; k <= 10; ++k) {
      factors.push_back(std::make_unique<graph::RelativePose>(graph::pose_key(k - 1),
                                                              graph::pose_key(k), Pose2(1, 0, 0),
                                                              Eigen::Matrix3d::Identity() / 0.05));
      values.set_pose(k, Pose2(k, 0, 0));
    }
    (void)back_end_->update(std::move(factors), values, {});
  }

  // "Key scan `key` is at x_m", good to 1 cm.
  static LoopClosure closure(std::uint32_t key, double x_m) {
    LoopClosure result;
    result.scan_key = key;
    result.match.T_map_base = Pose2(x_m, 0, 0);
    result.match.information = 1e4 * Eigen::Matrix3d::Identity();
    result.match.num_observable = 3;
    return result;
  }

  std::unique_ptr<backend::BackEnd> back_end_ =
      backend::make_least_squares(backend::LeastSquaresParams{});
  LoopEdges edges_{kGate};
};

TEST_F(LoopEdgesTest, AClosureThatAgreesStays) {
  const std::vector<LoopClosure> closures = {closure(10, 10.05)};
  const LoopEdges::Outcome outcome = edges_.add(closures, *back_end_);
  EXPECT_TRUE(outcome.is_any_kept);
  EXPECT_EQ(edges_.num_added(), 1);
  EXPECT_EQ(edges_.num_removed(), 0);
  EXPECT_NEAR(back_end_->estimate().pose(10).x_m(), 10.05, 0.005);
}

TEST_F(LoopEdgesTest, AFalseClosureIsTakenOutAndTheTrueOneThatItBentStays) {
  // Together, both are far beyond the gate; alone, the true one fits.
  const std::vector<LoopClosure> closures = {closure(9, 5), closure(10, 10)};
  const LoopEdges::Outcome outcome = edges_.add(closures, *back_end_);
  EXPECT_TRUE(outcome.is_any_kept);
  EXPECT_EQ(edges_.num_added(), 2);
  EXPECT_EQ(edges_.num_removed(), 1);
  EXPECT_NEAR(back_end_->estimate().pose(9).x_m(), 9, 1e-3);
  EXPECT_NEAR(back_end_->estimate().pose(10).x_m(), 10, 1e-3);
}

TEST_F(LoopEdgesTest, ALaterClosureCanProveAnEarlierOneFalse) {
  // A metre off: the chain before it gives way, until both neighbours say otherwise.
  const std::vector<LoopClosure> wrong = {closure(9, 10)};
  EXPECT_TRUE(edges_.add(wrong, *back_end_).is_any_kept);
  const std::vector<LoopClosure> right = {closure(8, 8), closure(10, 10)};
  EXPECT_TRUE(edges_.add(right, *back_end_).is_any_kept);
  EXPECT_EQ(edges_.num_removed(), 1);
  EXPECT_NEAR(back_end_->estimate().pose(9).x_m(), 9, 1e-3);
}

TEST_F(LoopEdgesTest, AKeyScanIsClosedOnce) {
  const std::vector<LoopClosure> closures = {closure(10, 10)};
  (void)edges_.add(closures, *back_end_);
  const LoopEdges::Outcome again = edges_.add(closures, *back_end_);
  EXPECT_FALSE(again.is_any_kept);
  EXPECT_TRUE(again.solves.empty());
  EXPECT_EQ(edges_.num_added(), 1);
}

}  // namespace
}  // namespace corridor::fusion
