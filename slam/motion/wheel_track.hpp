// The recent wheel odometry as a function of time, so that sensors with other clocks can ask for
// the motion between their own stamps.
#pragma once

#include <deque>
#include <optional>
#include <utility>

#include "slam/core/wheel.hpp"
#include "slam/motion/wheel_preintegration.hpp"

namespace corridor::motion {

// What the wheels were read to say at a moment, from the samples that had come by then.
struct WheelReading {
  Timestamp moment;  // of the wheels' clock
  Pose2 T_odom_axle;
  Eigen::Vector3d twist;  // (m/s, m/s, rad/s), axle
};

class WheelTrack {
 public:
  // Samples arrive in time order; those much older than the newest are dropped. One with the stamp
  // of the last takes its place.
  void add(const WheelSample& sample);
  // T_odom_base at a moment: interpolated on the geodesic between two samples, or carried on with
  // the last twist for at most kMaxExtrapolation_s. nullopt when no sample is near.
  [[nodiscard]] std::optional<Pose2> pose_at(Timestamp stamp) const;
  // The reading for a moment of the LiDAR's clock, delay_s later by the wheels'. Interpolated, or
  // carried on with the last twist; nullopt where pose_at(stamp) has none.
  [[nodiscard]] std::optional<WheelReading> read(Timestamp stamp, double delay_s) const;
  // The motion from one reading to a later one, along the samples between them. It begins where the
  // first was read to be and not where better knowledge would put it now: the motions from reading
  // to reading add up to that from the first to the last.
  [[nodiscard]] WheelDelta between(const WheelReading& from, const WheelReading& to,
                                   const WheelCalibration& calibration) const;

  static constexpr double kMaxExtrapolation_s = 0.25;

 private:
  // The sample at or after a moment, the last one if there is none, and the one before it. Requires
  // two samples.
  [[nodiscard]] std::pair<const WheelSample*, const WheelSample*> around(Timestamp moment) const;

  static constexpr double kHistory_s = 10.0;

  std::deque<WheelSample> samples_;
};

}  // namespace corridor::motion
