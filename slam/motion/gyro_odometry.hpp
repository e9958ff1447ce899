// Wheel odometry with its turns corrected by a gyro: an extended Kalman filter [Thrun2005, sec.
// 3.3] of heading and gyro bias, for systems that read wheels and LiDAR alone.
#pragma once

#include <optional>

#include "slam/core/imu.hpp"
#include "slam/core/robot_model.hpp"
#include "slam/core/wheel.hpp"
#include "slam/motion/imu_track.hpp"

namespace corridor::motion {

class GyroOdometry {
 public:
  explicit GyroOdometry(const RobotModel& robot);

  // Readings in order of time, those of both sensors together.
  void add(const ImuSample& sample) { gyro_.add(sample); }
  // The sample with T_odom_base as the filter has it, beginning where the wheels' own odometry did.
  // Where the gyro was silent since the sample before, the turn is the wheels'. Ticks stay.
  WheelSample corrected(const WheelSample& sample);

  // Of the gyro, with its variance.
  [[nodiscard]] double bias_radps() const { return bias_radps_; }
  [[nodiscard]] double bias_variance() const { return bias_variance_; }

 private:
  double turn_of(double wheel_turn_rad, double path_m, double duration_s);

  WheelModel wheels_;
  ImuModel imu_;
  ImuTrack gyro_;
  std::optional<WheelSample> last_;  // as the wheels gave it
  Pose2 T_odom_base_;
  double bias_radps_ = 0, bias_variance_;
};

}  // namespace corridor::motion
