// Decides by odometry and time alone whether a scan becomes a key scan.
#pragma once

#include "baselines/karto/karto_params.hpp"
#include "baselines/karto/key_scan.hpp"

namespace corridor::karto {

// True if since the last key scan the sensor moved by `min_travel_distance_m`, or turned by
// `min_travel_heading_rad`, or `min_time_interval_s` passed; each bound included.
inline bool is_key_scan(const KeyScan& last, const KeyScan& scan, const KartoParams& params) {
  const Pose2 T_last_scan = last.T_odom_sensor().between(scan.T_odom_sensor());
  return seconds_between(last.stamp(), scan.stamp()) >= params.min_time_interval_s ||
         std::abs(T_last_scan.theta_rad()) >= params.min_travel_heading_rad ||
         T_last_scan.translation_m().norm() >= params.min_travel_distance_m;
}

}  // namespace corridor::karto
