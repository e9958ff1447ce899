// The recent wheel odometry as a function of time, so that sensors with other clocks can ask for
// the motion between their own stamps.
#pragma once

#include <deque>
#include <optional>

#include "slam/core/wheel.hpp"

namespace corridor::motion {

class WheelTrack {
 public:
  // Samples arrive in time order; those much older than the newest are dropped.
  void add(const WheelSample& sample);
  // T_odom_base at a moment: interpolated on the geodesic between two samples, or carried on with
  // the last twist for at most kMaxExtrapolation_s. nullopt when no sample is near.
  [[nodiscard]] std::optional<Pose2> pose_at(Timestamp stamp) const;

  static constexpr double kMaxExtrapolation_s = 0.25;

 private:
  static constexpr double kHistory_s = 10.0;

  std::deque<WheelSample> samples_;
};

}  // namespace corridor::motion
