// The simulated IMU: yaw rate and specific force where it is mounted, and its errors. It knows no
// scenario file and no clock.
#pragma once

#include "datasets/simulation/bias_drift.hpp"
#include "datasets/simulation/robot_drive.hpp"
#include "datasets/simulation/sensor_params.hpp"
#include "slam/core/imu.hpp"
#include "slam/core/rng.hpp"

namespace corridor::simulation {

// What is wrong with the IMU for a whole log.
struct ImuErrors {
  double gyro_bias_radps = 0;
  double accel_bias_x_mps2 = 0;
  double accel_bias_y_mps2 = 0;
  double gyro_scale = 1;  // reading / truth
  double accel_scale_x = 1;
  double accel_scale_y = 1;
  double misalignment_rad = 0;  // its true yaw in the base minus the stated one
};
ImuErrors draw_imu_errors(const ImuParams& params, const Rng& rng);

// What is added to the IMU's reading besides white noise and vibration.
struct ImuBias {
  double gyro_radps = 0;
  double accel_x_mps2 = 0;  // in the IMU's frame, with the gravity that the floor's tilt leaks in
  double accel_y_mps2 = 0;
};

// The floor's slopes along the world's axes where the robot is: first-order Gauss-Markov in the
// path. They belong to the floor: a robot that turns on the spot feels them from another side.
class FloorTilt {
 public:
  FloorTilt(const ImuParams& params, Rng rng);
  // Moves on by a part of the path; gives the share of gravity along the world's x and y [m/s2].
  Eigen::Vector2d advance(double path_m);

 private:
  double sigma_rad_, length_m_;
  Rng rng_;
  Eigen::Vector2d tilt_rad_;
};

class ImuModel2d {
 public:
  ImuModel2d(const ImuParams& params, const ImuErrors& errors, double step_s, const Rng& rng);

  // Reading at state `to`, a step after `from`. Must be called for every step, in order.
  ImuSample measure(const DriveState& from, const DriveState& to, Timestamp stamp);
  // That of the last reading.
  [[nodiscard]] const ImuBias& bias() const { return bias_; }
  // False where the bias is that of ImuErrors for the whole log.
  [[nodiscard]] bool has_varying_bias() const;

 private:
  ImuParams params_;
  ImuErrors errors_;
  double step_s_;
  Pose2 T_base_imu_;  // true
  BiasDrift gyro_drift_, accel_x_drift_, accel_y_drift_;
  FloorTilt tilt_;
  ImuBias bias_;
  Rng noise_, vibration_;
};

}  // namespace corridor::simulation
