// The recent wheel odometry as a function of time, so that sensors with other clocks can ask for
// the motion between their own stamps.
#pragma once

#include <deque>
#include <optional>

#include "slam/core/wheel.hpp"
#include "slam/motion/wheel_preintegration.hpp"

namespace corridor::motion {

class WheelTrack {
 public:
  // Samples arrive in time order; those much older than the newest are dropped.
  void add(const WheelSample& sample);
  // T_odom_base at a moment: interpolated on the geodesic between two samples, or carried on with
  // the last twist for at most kMaxExtrapolation_s. nullopt when no sample is near.
  [[nodiscard]] std::optional<Pose2> pose_at(Timestamp stamp) const;
  // Motion from one moment to a later one, read the calibration's delay later; nullopt where
  // pose_at() has none.
  [[nodiscard]] std::optional<WheelDelta> between(Timestamp from, Timestamp to,
                                                  const WheelCalibration& calibration) const;

  static constexpr double kMaxExtrapolation_s = 0.25;

 private:
  // (m/s, m/s, rad/s) in the axle's frame, between the two samples around a moment.
  [[nodiscard]] Eigen::Vector3d twist_at(Timestamp stamp) const;

  static constexpr double kHistory_s = 10.0;

  std::deque<WheelSample> samples_;
};

}  // namespace corridor::motion
