#include "slam/fusion/loop_edges.hpp"

#include <gtest/gtest.h>

#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"
#include "slam/graph/factors/pose_factors.hpp"

namespace corridor::fusion {
namespace {

// Key scans 0 to 10, a metre apart on the x axis; odometry between them is good to 5 cm.
class LoopEdgesTest : public ::testing::Test {
 protected:
  LoopEdgesTest() {
    std::vector<graph::NewFactor> factors;
    graph::Values values;
    factors.push_back(
        graph::PosePrior(graph::pose_key(0), Pose2(), Eigen::Matrix3d::Identity() / 1e-4));
    values.set_pose(0, Pose2());
    for (std::uint32_t k = 1; k <= 10; ++k) {
      factors.push_back(graph::RelativePose(graph::pose_key(k - 1), graph::pose_key(k),
                                            Pose2(1, 0, 0), Eigen::Matrix3d::Identity() / 0.05));
      values.set_pose(k, Pose2(k, 0, 0));
    }
    (void)back_end_->update(std::move(factors), values, {});
  }

  // "Key scan `key` is at x_m", good to 1 cm.
  static LoopClosure closure(std::uint32_t key, double x_m) {
    LoopClosure result;
    result.scan_key = key;
    result.path_m = key;
    result.match.T_map_base = Pose2(x_m, 0, 0);
    result.match.information = 1e4 * Eigen::Matrix3d::Identity();
    result.match.num_observable = 3;
    return result;
  }

  std::unique_ptr<backend::BackEnd> back_end_ =
      backend::make_least_squares(backend::LeastSquaresParams{});
  FusionParams params_;
  LoopEdges edges_{params_};
};

TEST_F(LoopEdgesTest, AClosureThatAgreesStays) {
  const std::vector<LoopClosure> closures = {closure(10, 10.05)};
  EXPECT_FALSE(edges_.add(closures, *back_end_).empty());
  EXPECT_EQ(edges_.num_in_graph(), 1u);
  EXPECT_EQ(edges_.num_removed(), 0);
  EXPECT_EQ(edges_.last_path_m(), 10);
  EXPECT_NEAR(back_end_->estimate().pose(10).x_m(), 10.05, 0.005);
}

TEST_F(LoopEdgesTest, AFalseClosureIsTakenOutAndTheTrueOneThatItBentStays) {
  // Together, both are far beyond the gate; alone, the true one fits.
  const std::vector<LoopClosure> closures = {closure(9, 5), closure(10, 10)};
  (void)edges_.add(closures, *back_end_);
  EXPECT_EQ(edges_.num_in_graph(), 1u);
  EXPECT_EQ(edges_.num_removed(), 1);
  EXPECT_NEAR(back_end_->estimate().pose(9).x_m(), 9, 1e-3);
  EXPECT_NEAR(back_end_->estimate().pose(10).x_m(), 10, 1e-3);
}

TEST_F(LoopEdgesTest, ALaterClosureCanProveAnEarlierOneFalse) {
  // A metre off: the chain before it gives way, until both neighbours say otherwise.
  const std::vector<LoopClosure> wrong = {closure(9, 10)};
  (void)edges_.add(wrong, *back_end_);
  EXPECT_EQ(edges_.num_in_graph(), 1u);
  const std::vector<LoopClosure> right = {closure(8, 8), closure(10, 10)};
  (void)edges_.add(right, *back_end_);
  EXPECT_EQ(edges_.num_in_graph(), 2u);
  EXPECT_EQ(edges_.num_removed(), 1);
  EXPECT_NEAR(back_end_->estimate().pose(9).x_m(), 9, 1e-3);
}

TEST_F(LoopEdgesTest, AFirmClosureStaysHoweverMuchTheRestContradictsIt) {
  std::vector<LoopClosure> closures = {closure(10, 0)};
  closures.front().is_firm = true;
  (void)edges_.add(closures, *back_end_);
  EXPECT_EQ(edges_.num_in_graph(), 1u);
  EXPECT_EQ(edges_.num_removed(), 0);
}

TEST_F(LoopEdgesTest, TheNewestClosureIsTheFarthestAlongThePathAndNotTheLastAdded) {
  (void)edges_.add(std::vector{closure(10, 10)}, *back_end_);
  (void)edges_.add(std::vector{closure(8, 8)}, *back_end_);
  EXPECT_EQ(edges_.last_path_m(), 10);
}

// The error of the submap's shape, 2 cm, on top of the closure's own 1 cm.
TEST_F(LoopEdgesTest, AClosureWeighsWhatItsOwnErrorAndTheSubmapsAllow) {
  (void)edges_.add(std::vector{closure(10, 10.1)}, *back_end_);
  const double variance_m2 = params_.loop_sigma_m * params_.loop_sigma_m + 1e-4;
  const double odometry_m2 = 10 * 0.05 * 0.05;
  const double expected_m = 10 + 0.1 * odometry_m2 / (odometry_m2 + variance_m2);
  EXPECT_NEAR(back_end_->estimate().pose(10).x_m(), expected_m, 1e-4);
}

TEST_F(LoopEdgesTest, AKeyScanIsClosedOnce) {
  const std::vector<LoopClosure> closures = {closure(10, 10)};
  (void)edges_.add(closures, *back_end_);
  EXPECT_TRUE(edges_.add(closures, *back_end_).empty());
  EXPECT_EQ(edges_.num_in_graph(), 1u);
}

TEST_F(LoopEdgesTest, AKeyScanWhoseFalseClosureIsGoneCanBeClosedAgainAndNothingElseStays) {
  const std::vector<LoopClosure> wrong = {closure(10, 0)};
  (void)edges_.add(wrong, *back_end_);
  // Alone against the chain it bends everything; the next one proves it false.
  const std::vector<LoopClosure> right = {closure(9, 9)};
  (void)edges_.add(right, *back_end_);
  ASSERT_EQ(edges_.num_removed(), 1);
  EXPECT_EQ(edges_.last_path_m(), 9);
  const std::vector<LoopClosure> again = {closure(10, 10)};
  EXPECT_FALSE(edges_.add(again, *back_end_).empty());
  EXPECT_EQ(edges_.num_in_graph(), 2u);
}

}  // namespace
}  // namespace corridor::fusion
