// A pose for every scan from the poses of the used ones: between two of them the odometry forward
// from the one before and backward from the one after, blended linearly.
#pragma once

#include <vector>

#include "slam/core/pose2.hpp"
#include "slam/core/trajectory.hpp"

namespace corridor::motion {

struct ScanRecord {
  Timestamp stamp;
  Pose2 T_odom_base;
  bool is_key = false;
};

// `key_poses` are T_map_base of the records with is_key, in order. A record between the keys a and
// b gets the blend of T_map_a * T_a_record and T_map_b * T_b_record (both by odometry): each of
// (x_m, y_m, theta_rad) linear in the record's number, theta the short way round. After the last
// key only the former. A key keeps its pose to the last bit. Requires that the first record is a
// key, as many poses as keys, and strictly increasing stamps.
Trajectory dense_path(const std::vector<ScanRecord>& records, const std::vector<Pose2>& key_poses);

}  // namespace corridor::motion
