#include "bench/metrics/consistency.hpp"

#include <gtest/gtest.h>

#include "slam/backend/isam2/isam2.hpp"
#include "slam/core/rng.hpp"

namespace corridor::metrics {
namespace {

// A drive around a square, measured from pose to pose and once around, with noise of sigma; the
// graph says that the noise is `believed` times sigma.
class NoisySquare final : public graph::GraphSource {
 public:
  NoisySquare(std::uint64_t seed, double believed) : back_end_(backend::make_isam2({})) {
    Rng rng(seed);
    std::vector<graph::NewFactor> factors;
    graph::Values values;
    Pose2 T_world_base(3, -1, 0.7);
    EXPECT_TRUE(truth_.append({stamp(0), T_world_base, {}}));
    values.set_pose(0, Pose2());
    const Eigen::Matrix3d weight =
        Eigen::Vector3d(1 / kSigma_m, 1 / kSigma_m, 1 / kSigma_rad).asDiagonal().toDenseMatrix() /
        believed;
    factors.emplace_back(
        graph::PosePrior(graph::pose_key(0), Pose2(), Eigen::Matrix3d::Identity() * 1e5));
    for (std::uint32_t k = 1; k < kNumPoses; ++k) {
      const Pose2 step(1, 0, k % 5 == 0 ? 1.5707963267948966 : 0);
      T_world_base = T_world_base * step;
      EXPECT_TRUE(truth_.append({stamp(k), T_world_base, {}}));
      const Pose2 measured = noisy(step, rng);
      values.set_pose(k, values.pose(k - 1) * measured);
      factors.emplace_back(
          graph::RelativePose(graph::pose_key(k - 1), graph::pose_key(k), measured, weight));
    }
    const Pose2 around = truth_.front().T_map_base.between(truth_.back().T_map_base);
    factors.emplace_back(graph::RelativePose(graph::pose_key(0), graph::pose_key(kNumPoses - 1),
                                             noisy(around, rng), weight));
    back_end_->update(std::move(factors), values, {});
    back_end_->solve();
  }

  const graph::FactorGraph& solved_graph() const override { return back_end_->graph(); }
  const graph::Values& solved_values() const override { return back_end_->estimate(); }
  std::vector<Timestamp> pose_stamps() const override {
    std::vector<Timestamp> stamps;
    for (const TrajectoryPose& pose : truth_.poses()) stamps.push_back(pose.stamp);
    return stamps;
  }
  const Trajectory& truth() const { return truth_; }

 private:
  static constexpr double kSigma_m = 0.02, kSigma_rad = 0.005;
  static constexpr std::uint32_t kNumPoses = 20;

  static Timestamp stamp(std::uint32_t k) { return timestamp_from_seconds(k); }
  static Pose2 noisy(const Pose2& step, Rng& rng) {
    const double x_m = rng.normal(0, kSigma_m);
    const double y_m = rng.normal(0, kSigma_m);
    return step.plus({x_m, y_m, rng.normal(0, kSigma_rad)});
  }

  std::unique_ptr<backend::BackEnd> back_end_;
  Trajectory truth_;
};

// 200 drives: the mean of a chi-square variable of 3 degrees of freedom lies in 3 +- 0.7 with a
// probability of 0.99995.
TEST(Consistency, OfAnEstimatorWithTheRightNoiseIsItsDegreesOfFreedom) {
  double last = 0, mean = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const NoisySquare square(seed, 1);
    const auto consistency = score_consistency(square, square.truth());
    ASSERT_TRUE(consistency.has_value());
    EXPECT_EQ(consistency->dof, 3);
    last += consistency->nees_last / 200;
    mean += consistency->nees_mean / 200;
  }
  EXPECT_NEAR(last, 3, 0.7);
  EXPECT_NEAR(mean, 3, 0.7);
}

TEST(Consistency, OfOneThatBelievesInHalfTheNoiseIsFourTimesAsLarge) {
  const NoisySquare right(7, 1), bold(7, 0.5);
  const auto of_right = score_consistency(right, right.truth());
  const auto of_bold = score_consistency(bold, bold.truth());
  ASSERT_TRUE(of_right && of_bold);
  EXPECT_NEAR(of_bold->nees_last / of_right->nees_last, 4, 0.01);
  EXPECT_NEAR(of_bold->nees_mean / of_right->nees_mean, 4, 0.01);
}

TEST(Consistency, NeedsTwoTruePoses) {
  const NoisySquare square(1, 1);
  EXPECT_FALSE(score_consistency(square, Trajectory()).has_value());
}

}  // namespace
}  // namespace corridor::metrics
