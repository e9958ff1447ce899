#include "slam/motion/dense_path.hpp"

#include <cstddef>

#include "slam/core/expect.hpp"

namespace corridor::motion {
namespace {

struct KeyPose {
  std::size_t record_index;
  Pose2 T_map_base;
};

std::vector<KeyPose> keys_of(const std::vector<ScanRecord>& records,
                             const std::vector<Pose2>& key_poses) {
  std::vector<KeyPose> keys;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (!records[i].is_key) continue;
    CORRIDOR_EXPECT(keys.size() < key_poses.size());
    keys.push_back({i, key_poses[keys.size()]});
  }
  CORRIDOR_EXPECT(keys.size() == key_poses.size());
  return keys;
}

// T_map_base of a record by odometry from a key, forward or backward.
Pose2 by_odometry(const KeyPose& key, const std::vector<ScanRecord>& records, std::size_t index) {
  return key.T_map_base * records[key.record_index].T_odom_base.between(records[index].T_odom_base);
}

Pose2 blend(const Pose2& from, const Pose2& to, double ratio) {
  return {from.x_m() + ratio * (to.x_m() - from.x_m()),
          from.y_m() + ratio * (to.y_m() - from.y_m()),
          from.theta_rad() + ratio * wrap_angle(to.theta_rad() - from.theta_rad())};
}

}  // namespace

Trajectory dense_path(const std::vector<ScanRecord>& records, const std::vector<Pose2>& key_poses) {
  Trajectory trajectory;
  if (records.empty()) return trajectory;
  CORRIDOR_EXPECT(records.front().is_key);
  const std::vector<KeyPose> keys = keys_of(records, key_poses);
  std::size_t key_index = 0;
  bool is_in_order = true;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const bool has_next = key_index + 1 < keys.size();
    if (has_next && keys[key_index + 1].record_index == i) ++key_index;
    const KeyPose& before = keys[key_index];
    Pose2 T_map_base = records[i].is_key ? before.T_map_base : by_odometry(before, records, i);
    if (!records[i].is_key && has_next) {
      const KeyPose& after = keys[key_index + 1];
      const double ratio = static_cast<double>(i - before.record_index) /
                           static_cast<double>(after.record_index - before.record_index);
      T_map_base = blend(T_map_base, by_odometry(after, records, i), ratio);
    }
    is_in_order &= trajectory.append({records[i].stamp, T_map_base, std::nullopt});
  }
  CORRIDOR_ENSURE(is_in_order);
  return trajectory;
}

}  // namespace corridor::motion
