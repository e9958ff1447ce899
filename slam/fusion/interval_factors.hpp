// Chooses and weights the factors of one interval between key scans: the paper's reconfigurable
// graph.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "slam/fusion/fusion_params.hpp"
#include "slam/fusion/key_scan.hpp"
#include "slam/fusion/sensor_health.hpp"
#include "slam/graph/any_factor.hpp"
#include "slam/matching/observability.hpp"
#include "slam/motion/imu_preintegration.hpp"
#include "slam/motion/wheel_preintegration.hpp"

namespace corridor::fusion {

// What the sensors said between key scan i and key scan j = i + 1.
struct Interval {
  std::uint32_t i = 0, j = 0;
  std::optional<motion::WheelDelta> wheels;
  motion::WheelCalibration wheel_calibration = motion::WheelCalibration::Zero();  // estimated
  std::uint32_t calibration = 0;                                                  // its number
  std::optional<motion::ImuDelta> imu;
  std::optional<matching::ObservableMatch> match;  // of scan j in the frame of the submap
  std::uint32_t submap_frame = 0;                  // its pose in the graph
  bool is_wheel_jump = false;  // the LiDAR, seeing every direction, contradicts the wheels
  std::optional<double> range_difference_m;  // of scans i and j, the paper's measure
  Pose2 tracked_T_i_j;                       // by prediction and match together
  Eigen::Vector2d velocity_base_i_mps = Eigen::Vector2d::Zero();
  double velocity_sigma_mps = 0;
  double anchor_age_s = 0;
};

struct IntervalVerdict {
  bool is_slip = false;
  bool is_degenerate = false;
  bool are_wheels_used = false;
  bool is_lidar_used = false;
  std::optional<std::size_t> lidar_factor;  // place of the LiDAR's among the factors
  bool is_least_bad_kept = false;  // everything but the IMU was excluded, one was taken back
};

// Appends the interval's factors.
IntervalVerdict add_interval_factors(const Interval& interval, const RobotModel& robot,
                                     double wheel_noise_factor, const FusionParams& params,
                                     std::vector<graph::NewFactor>& factors);

// The factors that fix the gauge, key scan 0 at T_map_base = identity, and start the wheels'
// calibration.
void add_first_factors(const FusionParams& params, std::vector<graph::NewFactor>& factors);

// Priors on the velocity and the biases of the key scan at which the IMU's states begin.
void add_imu_priors(std::uint32_t key, const FusionParams& params,
                    std::vector<graph::NewFactor>& factors);

}  // namespace corridor::fusion
