// The improved proposal of [Grisetti2007] section III-B: a Gaussian fitted to the target density on
// a lattice of poses around the best match. The shipped program leaves it out (see README).
#pragma once

#include <Eigen/Core>
#include <functional>

#include "baselines/gmapping/gmapping_params.hpp"
#include "baselines/gmapping/motion_model.hpp"
#include "slam/core/pose2.hpp"
#include "slam/core/rng.hpp"

namespace corridor::gmapping {

// Order (x_m, y_m, theta_rad), position in map axes.
struct GaussianProposal {
  Eigen::Vector3d mean_map = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_map = Eigen::Matrix3d::Zero();
  double log_normaliser = 0;  // log of the target's mean over the lattice
};

// Mean, covariance and normaliser (eq. 14-18) of exp(log_target(pose)) over the lattice around
// `centre` that the parameters describe.
GaussianProposal fit_proposal(const Pose2& centre, const GmappingParams& params,
                              const std::function<double(const Pose2&)>& log_target);

// A sample. A direction without spread has none in the sample either.
Pose2 draw_pose(const GaussianProposal& proposal, Rng& rng);

// Log-density, up to a constant that depends on the noise alone, of coming from T_map_before to
// T_map_after when odometry says T_before_after: the motion model of motion_model.hpp. What has no
// noise is not compared.
double log_motion_density(const Pose2& T_map_before, const Pose2& T_map_after,
                          const Pose2& T_before_after, const MotionNoise& noise);

}  // namespace corridor::gmapping
