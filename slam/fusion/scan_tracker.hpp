// Follows the robot from scan to scan: predicts, matches against the active submap, and tells what
// the LiDAR alone measured and how far that is from the wheels.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "slam/core/robot_model.hpp"
#include "slam/fusion/fusion_params.hpp"
#include "slam/fusion/motion_predictor.hpp"
#include "slam/fusion/submap.hpp"
#include "slam/matching/observability.hpp"

namespace corridor::fusion {

struct TrackedScan {
  Pose2 T_submap_base;                             // scan and prediction together
  std::optional<matching::ObservableMatch> match;  // the scan's own say; none if it did not fit
  // Chi-square of the LiDAR against what the wheels predicted along the directions the scan sees,
  // and their number; without the turn where that came from the gyro. Only with wheels.
  std::optional<double> wheel_chi2;
  int wheel_degrees_of_freedom = 0;
  int num_outvoted = 0;     // directions of the match that wheels and IMU both contradict
  bool is_refused = false;  // it contradicted the prediction and explained too little of the scan
};

// may_refuse: false takes a match even if it contradicts the prediction, so that a wrong prediction
// cannot refuse the truth for ever. T_submap_last: pose at the last scan. The match starts from the
// prediction but is held by it only loosely, so that wheels which jump do not hold the scan back;
// what the scan does not see stays predicted.
TrackedScan track_scan(Submap& submap, std::span<const Eigen::Vector2d> points_base_m,
                       const Pose2& T_submap_last, const Prediction& prediction,
                       const RobotModel& robot, const FusionParams& params, bool may_refuse);

// What a scan that lies in the submap, at about T_submap_base, says of its own place there; nullopt
// if the submap does not explain it.
std::optional<matching::ObservableMatch> match_again(Submap& submap,
                                                     std::span<const Eigen::Vector2d> points_base_m,
                                                     const Pose2& T_submap_base,
                                                     const RobotModel& robot,
                                                     const FusionParams& params);

}  // namespace corridor::fusion
