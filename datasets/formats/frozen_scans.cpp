#include "datasets/formats/frozen_scans.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "slam/core/same_reading.hpp"

namespace corridor::formats {
namespace {

bool has_return(const LaserScan& scan) {
  return std::any_of(scan.is_valid.begin(), scan.is_valid.end(),
                     [](std::uint8_t is_valid) { return is_valid != 0; });
}

}  // namespace

FrozenScans longest_frozen_scans(const SensorLog& log) {
  FrozenScans longest, run;
  const LaserScan* last = nullptr;
  Pose2 T_odom_base;  // the wheels' last reading
  Pose2 T_odom_first;
  for (std::size_t i = 0; i < log.events.size(); ++i) {
    if (const auto* sample = std::get_if<WheelSample>(&log.events[i])) {
      T_odom_base = sample->T_odom_base.is_finite() ? sample->T_odom_base : T_odom_base;
    }
    const auto* scan = std::get_if<LaserScan>(&log.events[i]);
    if (scan == nullptr || !has_return(*scan)) continue;
    if (last == nullptr || !is_same_reading(*last, *scan)) {
      run = {};
      T_odom_first = T_odom_base;
    }
    last = scan;
    ++run.num_scans;
    run.last_event_index = i;
    const Pose2 T_first_base = T_odom_first.between(T_odom_base);
    run.moved_m = std::max(run.moved_m, T_first_base.translation_m().norm());
    run.turned_rad = std::max(run.turned_rad, std::abs(T_first_base.theta_rad()));
    if (std::pair(run.moved_m, run.turned_rad) > std::pair(longest.moved_m, longest.turned_rad)) {
      longest = run;
    }
  }
  return longest;
}

}  // namespace corridor::formats
