#include "baselines/gmapping/motion_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

namespace corridor::gmapping {
namespace {

constexpr double kExact = 1e-12;

TEST(GmappingMotionNoise, EqualsTheHandComputedStandardDeviations) {
  const MotionNoise noise = motion_noise(Pose2(0.5, -0.2, 0.1), GmappingParams{});
  EXPECT_NEAR(noise.x_m, 0.1 * 0.5 + 0.1 * 0.1 + 0.03 * 0.2, kExact);
  EXPECT_NEAR(noise.y_m, 0.1 * 0.2 + 0.1 * 0.1 + 0.03 * 0.5, kExact);
  EXPECT_NEAR(noise.theta_rad, 0.2 * 0.1 + 0.2 * std::hypot(0.5, 0.2), kExact);
}

TEST(GmappingMotionNoise, IsTheSameForwardsAndBackwards) {
  const MotionNoise forward = motion_noise(Pose2(0.5, 0.1, 0.2), GmappingParams{});
  const MotionNoise backward = motion_noise(Pose2(-0.5, -0.1, -0.2), GmappingParams{});
  EXPECT_DOUBLE_EQ(forward.x_m, backward.x_m);
  EXPECT_DOUBLE_EQ(forward.y_m, backward.y_m);
  EXPECT_DOUBLE_EQ(forward.theta_rad, backward.theta_rad);
}

TEST(GmappingMotionSample, LeavesAStandingRobotExactlyWhereItIs) {
  const Pose2 start(1, 2, 0.3);
  Rng rng(1);
  EXPECT_EQ(sample_motion(start, Pose2(), motion_noise(Pose2(), GmappingParams{}), rng), start);
}

TEST(GmappingMotionSample, HasTheMomentsOfTheModelInTheBodyFrame) {
  const Pose2 start(3, -2, 2.1);
  const Pose2 step(0.4, 0.1, -0.3);
  const MotionNoise noise = motion_noise(step, GmappingParams{});
  const Eigen::Array3d sigma(noise.x_m, noise.y_m, noise.theta_rad);
  constexpr int kNumSamples = 40000;
  Rng rng(7);
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  Eigen::Array3d sum_of_squares = Eigen::Array3d::Zero();
  for (int i = 0; i < kNumSamples; ++i) {
    const Pose2 moved = start.between(sample_motion(start, step, noise, rng));
    const Eigen::Array3d error = Eigen::Array3d(moved.x_m(), moved.y_m(), moved.theta_rad()) -
                                 Eigen::Array3d(step.x_m(), step.y_m(), step.theta_rad());
    sum += error;
    sum_of_squares += error.square();
  }
  // Five standard deviations of the mean and of the variance of Gaussian samples.
  const Eigen::Array3d mean = sum / kNumSamples;
  const Eigen::Array3d variance = sum_of_squares / kNumSamples;
  EXPECT_TRUE((mean.abs() < 5 * sigma / std::sqrt(kNumSamples)).all()) << mean;
  EXPECT_TRUE(
      ((variance - sigma.square()).abs() < 5 * sigma.square() * std::sqrt(2.0 / kNumSamples)).all())
      << variance;
}

}  // namespace
}  // namespace corridor::gmapping
