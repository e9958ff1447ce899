#include "baselines/gmapping/proposal.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <Eigen/LU>

#include <cmath>

namespace corridor::gmapping {
namespace {

GmappingParams lattice(double linear_m, double angular_rad, int num_steps) {
  GmappingParams params;
  params.proposal_linear_range_m = linear_m;
  params.proposal_linear_step_m = linear_m / num_steps;
  params.proposal_angular_range_rad = angular_rad;
  params.proposal_angular_step_rad = angular_rad / num_steps;
  return params;
}

TEST(Proposal, OfAFlatTargetIsTheLatticesOwnMeanAndCovariance) {
  const Pose2 centre(1, 2, 0.5);
  const GaussianProposal proposal =
      fit_proposal(centre, lattice(0.01, 0.005, 1), [](const Pose2&) { return -7.0; });
  EXPECT_LT((proposal.mean_map - Eigen::Vector3d(1, 2, 0.5)).norm(), 1e-12);
  // Three values -r, 0, r per axis: variance 2 r^2 / 3.
  const Eigen::Vector3d variances(2e-4 / 3, 2e-4 / 3, 5e-5 / 3);
  EXPECT_LT((proposal.covariance_map - Eigen::Matrix3d(variances.asDiagonal())).norm(), 1e-12);
  EXPECT_NEAR(proposal.log_normaliser, -7, 1e-12);
}

TEST(Proposal, OfAGaussianTargetIsThatGaussian) {
  const Eigen::Vector3d mean(0.013, -0.007, 0.004);
  Eigen::Matrix3d covariance;
  covariance << 4e-4, 1e-4, 2e-5, 1e-4, 3e-4, -1e-5, 2e-5, -1e-5, 1e-4;
  const Eigen::Matrix3d information = covariance.inverse();
  const GaussianProposal proposal =
      fit_proposal({}, lattice(0.12, 0.06, 24), [&](const Pose2& pose) {
        const Eigen::Vector3d d = Eigen::Vector3d(pose.x_m(), pose.y_m(), pose.theta_rad()) - mean;
        return -0.5 * d.dot(information * d);
      });
  EXPECT_LT((proposal.mean_map - mean).norm(), 1e-6);
  EXPECT_LT((proposal.covariance_map - covariance).norm(), 1e-8);
}

TEST(Proposal, OfALikelihoodFarBelowUnderflowIsStillRight) {
  const GaussianProposal proposal = fit_proposal(
      {}, lattice(0.01, 0.005, 1), [](const Pose2& pose) { return -1e6 + 100 * pose.x_m(); });
  EXPECT_GT(proposal.mean_map.x(), 0.004);
  EXPECT_TRUE(proposal.covariance_map.allFinite());
  EXPECT_LT(proposal.log_normaliser, -999000);
}

TEST(Proposal, SamplesHaveItsMeanAndCovariance) {
  GaussianProposal proposal;
  proposal.mean_map << 1, -2, 0.3;
  proposal.covariance_map << 4e-2, 1e-2, 2e-3, 1e-2, 3e-2, -1e-3, 2e-3, -1e-3, 1e-2;
  Rng rng(5);
  constexpr int kNumSamples = 20000;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kNumSamples; ++i) {
    const Pose2 pose = draw_pose(proposal, rng);
    const Eigen::Vector3d d =
        Eigen::Vector3d(pose.x_m(), pose.y_m(), pose.theta_rad()) - proposal.mean_map;
    sum += d;
    squares += d * d.transpose();
  }
  // Five standard errors: sigma / sqrt(n), and sqrt(2 / n) of a variance.
  EXPECT_LT((sum / kNumSamples).cwiseAbs().maxCoeff(), 5 * 0.2 / std::sqrt(kNumSamples));
  EXPECT_LT((squares / kNumSamples - proposal.covariance_map).cwiseAbs().maxCoeff(),
            5 * 0.04 * std::sqrt(2.0 / kNumSamples));
}

TEST(Proposal, ASampleDoesNotLeaveItsMeanWithoutSpread) {
  GaussianProposal proposal;
  proposal.mean_map << 1, 2, 3;
  Rng rng(1);
  EXPECT_EQ(draw_pose(proposal, rng), Pose2(1, 2, 3));
  // Two coordinates that move together.
  proposal.covariance_map << 1e-2, 1e-2, 0, 1e-2, 1e-2, 0, 0, 0, 0;
  const Pose2 pose = draw_pose(proposal, rng);
  EXPECT_NE(pose.x_m(), 1);
  EXPECT_NEAR(pose.x_m() - 1, pose.y_m() - 2, 1e-9);
}

RC_GTEST_PROP(MotionDensity, IsLargestWhereOdometrySaysAndFallsByHalfASquaredSigma,
              (std::uint64_t seed)) {
  Rng rng(seed);
  const Pose2 before(rng.uniform(-9, 9), rng.uniform(-9, 9), rng.uniform(-3, 3));
  const Pose2 motion(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
  const MotionNoise noise{.x_m = 0.1, .y_m = 0.2, .theta_rad = 0.3};
  RC_ASSERT(std::abs(log_motion_density(before, before * motion, motion, noise)) < 1e-20);
  const Pose2 off = before * Pose2(motion.x_m() + 0.1, motion.y_m() - 0.4, motion.theta_rad());
  RC_ASSERT(std::abs(log_motion_density(before, off, motion, noise) + 0.5 * (1 + 4)) < 1e-9);
}

}  // namespace
}  // namespace corridor::gmapping
