#include "slam/fusion/interval_factors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include "slam/fusion/calibration.hpp"

namespace corridor::fusion {
namespace {

motion::ImuDelta still_imu(double duration_s) {
  motion::ImuPreintegrator integrator(ImuModel{}, motion::ImuBias::Zero());
  for (double t = 0; t < duration_s - 1e-9; t += 0.005) integrator.integrate({}, 0.005);
  return integrator.delta();
}

motion::WheelDelta by_wheels(const Pose2& motion) {
  motion::WheelDelta delta;
  delta.append(motion);
  return delta;
}

// A straight step of 0.2 m in 0.4 s that every sensor agrees on.
Interval healthy() {
  Interval interval;
  interval.j = 1;
  interval.wheels = by_wheels(Pose2(0.2, 0, 0));
  interval.imu = still_imu(0.4);
  interval.velocity_base_i_mps = {0.5, 0};
  matching::ObservableMatch match;
  match.T_map_base = Pose2(0.2, 0, 0);
  match.information = 1e4 * Eigen::Matrix3d::Identity();
  match.num_observable = 3;
  interval.match = match;
  interval.range_difference_m = 0.2;
  interval.anchor_age_s = 0.4;
  interval.velocity_sigma_mps = 0.02;
  interval.tracked_T_i_j = Pose2(0.2, 0, 0);
  return interval;
}

struct Chosen {
  IntervalVerdict verdict;
  std::vector<graph::NewFactor> factors;

  [[nodiscard]] long count(std::string_view type) const {
    return std::count_if(factors.begin(), factors.end(),
                         [&](const graph::NewFactor& f) { return name_of(f.factor) == type; });
  }
};

Chosen choose(const Interval& interval, const FusionParams& params) {
  Chosen chosen;
  chosen.verdict = add_interval_factors(interval, RobotModel{}, 1, params, chosen.factors);
  return chosen;
}

class BothMethods : public ::testing::TestWithParam<bool> {
 protected:
  FusionParams params_ = GetParam() ? FusionParams{} : fusion_paper_params();
};
INSTANTIATE_TEST_SUITE_P(, BothMethods, ::testing::Bool(), [](const auto& method) {
  return method.param ? "Fusion" : "FusionPaper";
});

TEST_P(BothMethods, UseEverySensorWhenAllAreHealthy) {
  const Chosen chosen = choose(healthy(), params_);
  EXPECT_FALSE(chosen.verdict.is_slip);
  EXPECT_FALSE(chosen.verdict.is_degenerate);
  EXPECT_EQ(chosen.count("imu_motion"), 1);
  EXPECT_EQ(chosen.count("bias_walk"), 1);
  EXPECT_EQ(chosen.count("wheel_motion"), 1);
  EXPECT_EQ(chosen.count("relative_pose"), 1);
}

TEST_P(BothMethods, LeaveSlippingWheelsOut) {
  Interval interval = healthy();
  interval.wheels = by_wheels(Pose2(0.5, 0, 0));
  const Chosen chosen = choose(interval, params_);
  EXPECT_TRUE(chosen.verdict.is_slip);
  EXPECT_EQ(chosen.count("wheel_motion"), 0);
  EXPECT_EQ(chosen.count("relative_pose"), 1);
}

TEST(FusionPaper, LeavesTheLidarOutWhenTheViewDoesNotChange) {
  Interval interval = healthy();
  interval.range_difference_m = 0.017;
  const Chosen chosen = choose(interval, fusion_paper_params());
  EXPECT_TRUE(chosen.verdict.is_degenerate);
  EXPECT_EQ(chosen.count("relative_pose"), 0);
  EXPECT_EQ(chosen.count("wheel_motion"), 1);
}

TEST(FusionPaper, AStandingRobotsUnchangedViewIsNoDegradation) {
  Interval interval = healthy();
  interval.range_difference_m = 0.017;
  interval.wheels = by_wheels(Pose2());
  interval.velocity_base_i_mps.setZero();
  EXPECT_FALSE(choose(interval, fusion_paper_params()).verdict.is_degenerate);
}

TEST(FusionPaper, KeepsTheLeastBadSensorWhenBothAreDegraded) {
  Interval interval = healthy();
  interval.range_difference_m = 0.02;             // 1.4 times beyond its threshold
  interval.wheels = by_wheels(Pose2(1.0, 0, 0));  // far beyond its own
  const Chosen chosen = choose(interval, fusion_paper_params());
  EXPECT_TRUE(chosen.verdict.is_slip);
  EXPECT_TRUE(chosen.verdict.is_degenerate);
  EXPECT_TRUE(chosen.verdict.is_least_bad_kept);
  EXPECT_EQ(chosen.count("relative_pose"), 1);
  EXPECT_EQ(chosen.count("wheel_motion"), 0);
}

TEST(Fusion, TakesFromTheLidarOnlyTheDirectionsItSees) {
  Interval interval = healthy();
  interval.match->information = Eigen::Vector3d(0, 1e4, 1e4).asDiagonal();
  interval.match->num_observable = 2;
  interval.match->T_map_base = Pose2(0, 0, 0);  // would pull back by 0.2 m along x
  const Chosen chosen = choose(interval, {});
  EXPECT_TRUE(chosen.verdict.is_degenerate);
  graph::Values values;
  values.set_pose(0, {});
  values.set_pose(1, {0.2, 0, 0});
  for (const graph::NewFactor& chosen_factor : chosen.factors) {
    if (name_of(chosen_factor.factor) == "relative_pose") {
      EXPECT_NEAR(chi2_of(chosen_factor.factor, values), 0, 1e-12);
    }
  }
}

TEST(Fusion, AWheelJumpTheLidarSeesLeavesTheWheelsOut) {
  Interval interval = healthy();
  interval.is_wheel_jump = true;
  EXPECT_EQ(choose(interval, {}).count("wheel_motion"), 0);
}

TEST(Fusion, WithoutImuAndLidarTheWheelsStay) {
  Interval interval = healthy();
  interval.imu.reset();
  interval.match.reset();
  interval.is_wheel_jump = true;
  const Chosen chosen = choose(interval, {});
  EXPECT_EQ(chosen.count("wheel_motion"), 1);
  EXPECT_TRUE(chosen.verdict.is_least_bad_kept);
}

TEST(Fusion, AStateThatNothingMeasuredIsHeldWhereItWasTracked) {
  Interval interval = healthy();
  interval.imu.reset();
  interval.wheels.reset();
  interval.match->num_observable = 2;
  interval.match->information = Eigen::Vector3d(0, 1e4, 1e4).asDiagonal();
  EXPECT_EQ(choose(interval, {}).count("relative_pose"), 2);
  interval.match.reset();
  EXPECT_EQ(choose(interval, {}).count("relative_pose"), 1);
}

double wheel_chi2(const Chosen& chosen, const graph::Values& values) {
  EXPECT_EQ(chosen.count("wheel_motion"), 1);
  double chi2 = 0;
  for (const graph::NewFactor& factor : chosen.factors) {
    if (name_of(factor.factor) == "wheel_motion") chi2 += chi2_of(factor.factor, values);
  }
  return chi2;
}

// Beside a gyro the heading of wheels counts only if their inequality is estimated.
TEST(Fusion, AfterAGapOfTheImuTheWheelsHeadingCounts) {
  Interval interval = healthy();
  interval.imu->unmeasured_s = 1;
  interval.imu->covariance += Eigen::Matrix<double, 5, 5>::Identity();
  graph::Values values;
  values.set_pose(0, {});
  values.set_pose(1, {0.2, 0, 0.5});
  values.set_wheel_calibration(0, motion::WheelCalibration::Zero());
  FusionParams params;
  params.use_wheel_turn = false;
  EXPECT_GT(wheel_chi2(choose(interval, params), values), 10);
  interval.imu = still_imu(0.4);
  EXPECT_LT(wheel_chi2(choose(interval, params), values), 1e-9);
  EXPECT_GT(wheel_chi2(choose(interval, {}), values), 10);
}

TEST(ImuBiasWalk, GrowsWithTheRootOfTime) {
  const ImuModel imu;
  EXPECT_NEAR(imu_bias_walk(imu, 4).x(), 2 * imu_bias_walk(imu, 1).x(), 1e-15);
}

TEST(FusionParams, DefaultsAreValidAndEveryNameIsUnique) {
  EXPECT_TRUE(param_violations(FusionParams{}).empty());
  EXPECT_TRUE(param_violations(fusion_paper_params()).empty());
  EXPECT_EQ(param_values(FusionParams{}).size(), param_table<FusionParams>().size());
}

}  // namespace
}  // namespace corridor::fusion
