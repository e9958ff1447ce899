// Two against one: wheels and IMU each say where the robot has got to, and the scan claims a place.
// What both contradict is not the robot's motion but something that moved before the LiDAR: a
// person whom the match follows. The paper's reconfigurable graph, per direction, with an
// innovation gate [BarShalom2001]. It does not find out what moved, and is silent without an IMU.
#pragma once

#include <Eigen/Core>

#include "slam/core/pose2.hpp"
#include "slam/fusion/fusion_params.hpp"
#include "slam/fusion/motion_predictor.hpp"
#include "slam/matching/observability.hpp"

namespace corridor::fusion {

// Where one sensor puts the robot, without a look at this scan or at the other sensor since the
// last.
struct Witness {
  Pose2 T_submap_base;
  Eigen::Matrix3d covariance;  // 3x3, base, order (x_m, y_m, theta_rad)
};

// The match without the seen directions v along which the innovation e against either witness has
// e^2 > gate * (v^T covariance v + variance of the match along v), v and e in units of the match's
// floors. Both must exceed it: a witness that knows little contradicts nothing. Where it is
// left out the match has information zero; match.T_map_base stays.
matching::ObservableMatch without_outvoted(const matching::ObservableMatch& match,
                                           const Witness& wheels, const Witness& imu, double gate,
                                           const matching::ObservabilityParams& floors);

// The vote on a match of the scan to which the prediction leads, from the pose at the last scan.
// The match as it is where one of the two witnesses is missing.
matching::ObservableMatch put_to_vote(const matching::ObservableMatch& match,
                                      const Pose2& T_submap_last, const Prediction& prediction,
                                      const FusionParams& params);

}  // namespace corridor::fusion
