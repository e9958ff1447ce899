// Decides by odometry and time alone whether a scan becomes a key scan.
#pragma once

#include "baselines/karto/karto_params.hpp"
#include "baselines/karto/key_scan.hpp"

namespace corridor::karto {

// Tolerance of the original on the squared distance [m^2].
inline constexpr double kDistanceTolerance_m2 = 1e-6;

// True if since the last key scan the sensor moved by `min_travel_distance_m` (its square within
// the tolerance), or turned by `min_travel_heading_rad`, or `min_time_interval_s` passed.
inline bool is_key_scan(const KeyScan& last, const KeyScan& scan, const KartoParams& params) {
  const Pose2 T_last_scan = last.T_odom_sensor().between(scan.T_odom_sensor());
  return seconds_between(last.stamp(), scan.stamp()) >= params.min_time_interval_s ||
         std::abs(T_last_scan.theta_rad()) >= params.min_travel_heading_rad ||
         T_last_scan.translation_m().squaredNorm() >=
             params.min_travel_distance_m * params.min_travel_distance_m - kDistanceTolerance_m2;
}

}  // namespace corridor::karto
