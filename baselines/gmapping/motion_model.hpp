// Sampled odometry motion model: independent Gaussian noise on the body-frame odometry step, its
// spread growing with the step's translation and rotation.
// It is not the textbook's rotate-translate-rotate model [Thrun2005]; it is the one GMapping ships.
#pragma once

#include "baselines/gmapping/gmapping_params.hpp"
#include "slam/core/pose2.hpp"
#include "slam/core/rng.hpp"

namespace corridor::gmapping {

// Standard deviations of (x_m, y_m, theta_rad) in the body frame of the earlier pose.
struct MotionNoise {
  double x_m = 0;
  double y_m = 0;
  double theta_rad = 0;

  // Of one step after another: variances add up.
  void add(const MotionNoise& step);
};

// For the odometry step T_before_after = (dx, dy, dtheta), with s_xy = 0.3 s_rr:
//   sigma_x     = s_rr |dx| + s_tr |dtheta| + s_xy |dy|
//   sigma_y     = s_rr |dy| + s_tr |dtheta| + s_xy |dx|
//   sigma_theta = s_tt |dtheta| + s_rt hypot(dx, dy)
MotionNoise motion_noise(const Pose2& T_before_after, const GmappingParams& params);

// A sample of T_map_base after the step. Zero motion has zero noise.
Pose2 sample_motion(const Pose2& T_map_base, const Pose2& T_before_after, const MotionNoise& noise,
                    Rng& rng);

}  // namespace corridor::gmapping
