#include "slam/fusion/scan_path.hpp"

#include "slam/core/expect.hpp"

namespace corridor::fusion {

Trajectory ScanPath::smoothed(std::span<const KeyScan> key_scans,
                              const graph::Values& estimate) const {
  Trajectory trajectory;
  bool is_in_order = true;
  for (const Record& record : records_) {
    Pose2 T_map_base = estimate.pose(record.key) * record.T_key_base;
    if (record.key < arrivals_.size()) {
      const Timestamp begin = key_scans[record.key].scan.stamp;
      const Timestamp end = key_scans[record.key + 1].scan.stamp;
      const double ratio = seconds_between(begin, record.stamp) / seconds_between(begin, end);
      const Pose2 final_step = estimate.pose(record.key).between(estimate.pose(record.key + 1));
      const Pose2::Tangent change = (arrivals_[record.key].inverse() * final_step).log();
      T_map_base = T_map_base * Pose2::exp(ratio * change);
    }
    is_in_order &= trajectory.append({record.stamp, T_map_base, std::nullopt});
  }
  CORRIDOR_ENSURE(is_in_order);
  return trajectory;
}

}  // namespace corridor::fusion
