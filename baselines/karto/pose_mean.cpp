#include "baselines/karto/pose_mean.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "slam/core/expect.hpp"

namespace corridor::karto {
namespace {

constexpr double kMinEigenvalue = 1e-9;  // (32 um)^2, far below a grid cell

}  // namespace

Eigen::Matrix3d information_of(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  const Eigen::Vector3d inverse = eigen.eigenvalues().cwiseMax(kMinEigenvalue).cwiseInverse();
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

Pose2 mean_pose(std::span<const PoseWithCovariance> estimates, HeadingMean heading_mean) {
  CORRIDOR_EXPECT(!estimates.empty());
  if (estimates.size() == 1) return estimates.front().T_map_sensor;
  Eigen::Matrix3d information_sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted_sum = Eigen::Vector3d::Zero();
  double cos_sum = 0;
  double sin_sum = 0;
  for (const auto& [T_map_sensor, covariance_map] : estimates) {
    const Eigen::Matrix3d information = information_of(covariance_map);
    const double heading_rad = T_map_sensor.theta_rad();
    information_sum += information;
    weighted_sum +=
        information * Eigen::Vector3d(T_map_sensor.x_m(), T_map_sensor.y_m(), heading_rad);
    const double weight = heading_mean == HeadingMean::kPlain ? 1.0 : information(2, 2);
    cos_sum += weight * std::cos(heading_rad);
    sin_sum += weight * std::sin(heading_rad);
  }
  const Eigen::Vector3d mean = information_sum.inverse() * weighted_sum;
  return {mean.x(), mean.y(), std::atan2(sin_sum, cos_sum)};
}

}  // namespace corridor::karto
