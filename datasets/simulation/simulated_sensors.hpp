// The three sensor models: LiDAR, wheel encoders and IMU. Each takes true motion and adds its
// errors. They know no scenario file and no order of events.
#pragma once

#include <optional>
#include <vector>

#include "datasets/simulation/ray_casting.hpp"
#include "datasets/simulation/robot_drive.hpp"
#include "datasets/simulation/scenario_params.hpp"
#include "slam/core/imu.hpp"
#include "slam/core/rng.hpp"
#include "slam/core/robot_model.hpp"
#include "slam/core/scan.hpp"
#include "slam/core/wheel.hpp"

namespace corridor::simulation {

// Farther than the sensor sees; the raw range of a beam without return.
inline constexpr double kNoReturnExcess_m = 1.0;

// Where each beam truly ends; nullopt beyond the sensor's range. The LiDAR sits in the base's
// origin.
std::vector<std::optional<RayCaster::Hit>> cast_beams(const RayCaster& caster,
                                                      const Pose2& T_world_base,
                                                      const LidarParams& params);

// Adds range noise. One number is drawn per beam, hit or not, so that a beam's noise does not
// depend on the sensor's range. A noisy range outside [range_min, range_max] is no return.
LaserScan measure_scan(const std::vector<std::optional<RayCaster::Hit>>& hits, Timestamp stamp,
                       const LidarParams& params, Rng rng);

struct WheelScales {
  double left = 1;
  double right = 1;
};
WheelScales draw_wheel_scales(const WheelParams& params, Rng rng);

// Encoders count whole ticks of the wheel's path; the odometry is integrated from the counted ticks
// with the nominal calibration, arc by arc.
class WheelEncoders {
 public:
  WheelEncoders(const WheelParams& params, const WheelModel& nominal, WheelScales scales, Rng rng)
      : params_(params), nominal_(nominal), scales_(scales), rng_(rng) {}

  // The robot has moved from one state to the next; spin_ratio is that of a slip, 0 without.
  void advance(const DriveState& from, const DriveState& to, double step_s, double spin_ratio);
  WheelSample sample(Timestamp stamp);

 private:
  WheelParams params_;
  WheelModel nominal_;
  WheelScales scales_;
  Rng rng_;
  double left_path_m_ = 0;
  double right_path_m_ = 0;
  WheelSample last_{.stamp = {}, .T_odom_base = {}, .ticks = WheelTicks{}};
};

struct ImuBias {
  double gyro_radps = 0;
  double accel_x_mps2 = 0;
  double accel_y_mps2 = 0;
};
ImuBias draw_imu_bias(const ImuParams& params, Rng rng);

// Yaw rate and specific force at state `to`: speed change of the step along x, v * yaw rate along
// y.
ImuSample measure_imu(const DriveState& from, const DriveState& to, double step_s, Timestamp stamp,
                      const ImuBias& bias, const ImuParams& params, Rng& rng);

}  // namespace corridor::simulation
