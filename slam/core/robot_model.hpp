// Calibration of the robot as the log states it: what a system may know about its sensors.
// The true errors of a simulated robot are not here; they lie beside the log, for scoring only.
#pragma once

#include <string>
#include <vector>

#include "slam/core/pose2.hpp"

namespace corridor {

struct WheelModel {
  double track_m = 0.35;  // distance between the wheels' contact points
  double left_m_per_tick = 1e-4;
  double right_m_per_tick = 1e-4;
  double sigma_m_per_sqrt_m = 0.01;  // random error of one wheel's path, grows with its root
};

struct LidarModel {
  Pose2 T_base_lidar;
  double range_min_m = 0.05;
  double range_max_m = 30.0;
  double range_sigma_m = 0.02;
  double scan_duration_s = 0;  // as LaserScan's: negative for a LiDAR that turns clockwise
  double time_offset_s = 0;    // LiDAR clock minus wheel clock
};

struct ImuModel {
  Pose2 T_base_imu;
  double rate_hz = 100;
  double gyro_noise_radps = 0.01;             // per sample, standard deviation
  double accel_noise_mps2 = 0.05;             // per sample, standard deviation
  double gyro_bias_walk_radps_sqrt_s = 1e-4;  // bias random walk, per root second
  double accel_bias_walk_mps2_sqrt_s = 1e-3;
};

struct RobotModel {
  std::string name = "robot";
  WheelModel wheels;
  LidarModel lidar;
  ImuModel imu;
};

// All rules broken, one line each ("wheels.track_m = -1: expected > 0"); empty = valid.
std::vector<std::string> violations(const RobotModel& robot);

}  // namespace corridor
