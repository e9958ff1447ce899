#include "baselines/karto/pose_graph.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>

#include "slam/backend/gauss_newton/levenberg_marquardt.hpp"

namespace corridor::karto {
namespace {

constexpr double kTight = 1e-9;

Eigen::Matrix3d covariance() {
  return (Eigen::Matrix3d() << 4e-4, 1e-4, 0, 1e-4, 9e-4, 0, 0, 0, 1e-5).finished();
}

PoseGraph make_graph() {
  return {backend::make_least_squares(backend::spa_params()), Pose2(1, 2, 0.5)};
}

TEST(MeanPose, WeighsPositionsByInformation) {
  const Eigen::Matrix3d wide = Eigen::Vector3d(3e-4, 1e-4, 1e-4).asDiagonal();
  const Eigen::Matrix3d narrow = Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal();
  const std::vector<PoseWithCovariance> estimates = {{{1, 0, 0.2}, wide}, {{2, 1, 0.4}, narrow}};
  const Pose2 mean = mean_pose(estimates, HeadingMean::kPlain);
  EXPECT_NEAR(mean.x_m(), 1.75, kTight);
  EXPECT_NEAR(mean.y_m(), 0.5, kTight);
  EXPECT_NEAR(mean.theta_rad(), 0.3, kTight);
}

TEST(MeanPose, AveragesHeadingsRoundTheCircleAndByWeightOnlyWhereAsked) {
  const double pi = std::numbers::pi;
  const Eigen::Matrix3d wide = Eigen::Vector3d(1e-4, 1e-4, 3e-4).asDiagonal();
  const Eigen::Matrix3d narrow = 1e-4 * Eigen::Matrix3d::Identity();
  const std::vector<PoseWithCovariance> estimates = {{{0, 0, pi - 0.01}, wide},
                                                     {{0, 0, -pi + 0.03}, narrow}};
  EXPECT_NEAR(wrap_angle(mean_pose(estimates, HeadingMean::kPlain).theta_rad() - pi), 0.01, kTight);
  // Weights 1 : 3, of -0.01 and 0.03; sines bend it by less than 1e-5.
  EXPECT_NEAR(wrap_angle(mean_pose(estimates, HeadingMean::kByInformation).theta_rad() - pi), 0.02,
              1e-5);
}

TEST(InformationOf, IsTheInverseAndFiniteForASingularMatrix) {
  EXPECT_LT((information_of(covariance()) * covariance() - Eigen::Matrix3d::Identity()).norm(),
            kTight);
  EXPECT_TRUE(information_of(Eigen::Matrix3d::Zero()).allFinite());
}

// The original's cost: e = (R_i^T (t_j - t_i) - z_t, theta_j - theta_i - z_theta), with the match's
// covariance rotated by the first pose's heading.
TEST(PoseGraph, AnEdgeCostsWhatTheOriginalsDoes) {
  const Pose2 from(1, 2, 0.5);
  const Pose2 to(1.3, 2.2, 0.8);
  const PoseWithCovariance matched{{1.32, 2.17, 0.77}, covariance()};
  PoseGraph pose_graph = make_graph();
  pose_graph.add_pose(from);
  pose_graph.add_pose(to);
  pose_graph.add_edge(0, from, 1, matched, Pose2());
  const Pose2 z = from.between(matched.T_map_sensor);
  const Pose2 is = from.between(to);
  const Eigen::Vector3d e(is.x_m() - z.x_m(), is.y_m() - z.y_m(), is.theta_rad() - z.theta_rad());
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  rotation.topLeftCorner<2, 2>() = from.rotation().transpose();
  const Eigen::Matrix3d in_first = rotation * covariance() * rotation.transpose();
  const double expected = e.dot(in_first.inverse() * e);
  EXPECT_NEAR(pose_graph.factors().chi2(pose_graph.values()), expected, 1e-9 * expected);
}

TEST(PoseGraph, KeepsTheFirstPoseAndGivesPosesInTheMappersFrame) {
  const Pose2 from(1, 2, 0.5);
  const PoseWithCovariance matched{{1.32, 2.17, 0.77}, covariance()};
  PoseGraph pose_graph = make_graph();
  pose_graph.add_pose(from);
  pose_graph.add_pose({1.3, 2.2, 0.8});
  pose_graph.add_edge(0, from, 1, matched, Pose2());
  pose_graph.solve();
  EXPECT_LT(pose_graph.pose(0).minus(from).norm(), 1e-6);
  EXPECT_LT(pose_graph.pose(1).minus(matched.T_map_sensor).norm(), 1e-6);
  // The variables themselves are in the frame of the trajectory, here that of the first pose.
  EXPECT_LT(pose_graph.values().pose(0).log().norm(), 1e-6);
}

// A sensor 1 m ahead whose heading has variance s^2 moves the base sideways by s.
TEST(CovarianceInBase, CarriesTheHeadingsUncertaintyOverTheSensorsArm) {
  const Eigen::Matrix3d heading_only = Eigen::Vector3d(0, 0, 1e-4).asDiagonal();
  const Pose2 T_base_sensor(1, 0, 0);
  const PoseWithCovariance matched{Pose2(3, 4, 1.1) * T_base_sensor, heading_only};
  const Eigen::Matrix3d expected =
      (Eigen::Matrix3d() << 0, 0, 0, 0, 1e-4, -1e-4, 0, -1e-4, 1e-4).finished();
  EXPECT_LT((covariance_in_base(matched, T_base_sensor) - expected).norm(), kTight);
}

}  // namespace
}  // namespace corridor::karto
