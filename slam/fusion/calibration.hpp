// Online calibration: what wheels, their clock, their axle and the gyro are believed to be before
// anything is measured, and how fast that changes. Where the LiDAR sees along the motion it
// measures them; where it does not, the robot drives on with what was learnt.
#pragma once

#include <cstdint>
#include <vector>

#include "slam/fusion/fusion_params.hpp"
#include "slam/graph/any_factor.hpp"
#include "slam/graph/values.hpp"
#include "slam/motion/imu_preintegration.hpp"
#include "slam/motion/wheel_preintegration.hpp"

namespace corridor::fusion {

// Standard deviations of the priors around zero. What is not estimated is as good as known.
motion::WheelCalibration wheel_calibration_sigma(const FusionParams& params);
// Of the change from one state of the calibration to the next, calibration_interval_m later.
motion::WheelCalibration wheel_calibration_walk(const FusionParams& params);
// The IMU's, with the gyro's scale.
motion::ImuBias imu_bias_sigma(const FusionParams& params);
// Of the change over a time.
motion::ImuBias imu_bias_walk(const ImuModel& imu, double duration_s);

// A copy of calibration `number` under the next number, and what ties the two: a walk, and a prior
// as wide as the first one's around the present estimate, which holds it where the back-end has
// forgotten the copy before.
void add_next_calibration(std::uint32_t number, const motion::WheelCalibration& estimate,
                          const FusionParams& params, graph::Values& values,
                          std::vector<graph::NewFactor>& factors);

// Whether any part of the wheels' calibration is estimated.
bool is_wheel_calibration_estimated(const FusionParams& params);

}  // namespace corridor::fusion
