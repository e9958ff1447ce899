// One pose from several matches of the same scan.
#pragma once

#include <span>

#include "slam/core/pose2.hpp"

namespace corridor::karto {

struct PoseWithCovariance {
  Pose2 T_map_sensor;
  // 3x3, order (x_m, y_m, theta_rad): position in map axes, heading.
  Eigen::Matrix3d covariance_map;
};

enum class HeadingMean { kPlain, kByInformation };

// Position and heading block: (sum P^-1)^-1 sum P^-1 x [Konolige2010]. The heading is then the
// circular mean, unweighted (as shipped) or weighted by 1 / variance. Requires at least one
// estimate.
Pose2 mean_pose(std::span<const PoseWithCovariance> estimates, HeadingMean heading_mean);

// Inverse of a covariance whose eigenvalues are first raised to at least 1e-9, so that a match that
// is certain in one direction cannot make it infinite.
Eigen::Matrix3d information_of(const Eigen::Matrix3d& covariance);

}  // namespace corridor::karto
