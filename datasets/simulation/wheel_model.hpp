// The simulated wheel encoders. They know no scenario file and no clock.
#pragma once

#include "datasets/simulation/robot_drive.hpp"
#include "datasets/simulation/sensor_params.hpp"
#include "slam/core/rng.hpp"
#include "slam/core/robot_model.hpp"
#include "slam/core/wheel.hpp"

namespace corridor::simulation {

// What is wrong with the wheels for a whole log: 1 = nothing.
struct WheelErrors {
  double left_scale = 1;  // recorded path / true path
  double right_scale = 1;
  double track_ratio = 1;  // true track / stated track
};
WheelErrors draw_wheel_errors(const WheelParams& params, const Rng& rng);

// Encoders count whole ticks of the wheel's path; the odometry is integrated from the counted ticks
// with the nominal calibration, arc by arc.
class WheelEncoders {
 public:
  WheelEncoders(const WheelParams& params, const WheelModel& nominal, WheelErrors errors, Rng rng)
      : params_(params), nominal_(nominal), errors_(errors), rng_(rng) {}

  // The wheels have turned from one state to the next; spin_ratio is that of a slip, 0 without.
  void advance(const DriveState& from, const DriveState& to, double step_s, double spin_ratio);
  // Odometry since the last sample.
  WheelSample sample(Timestamp stamp);

 private:
  WheelParams params_;
  WheelModel nominal_;
  WheelErrors errors_;
  Rng rng_;
  double left_path_m_ = 0;
  double right_path_m_ = 0;
  WheelSample last_{.stamp = {}, .T_odom_base = {}, .ticks = WheelTicks{}};
};

}  // namespace corridor::simulation
