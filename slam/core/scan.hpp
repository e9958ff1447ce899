// One sweep of a planar LiDAR as the sensor gave it.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "slam/core/pose2.hpp"
#include "slam/core/timestamp.hpp"

namespace corridor {

// Beams are ordered counter-clockwise: beam i points to angle_min_rad + i * angle_increment_rad in
// the LiDAR frame and was taken at stamp + i * duration_s / (n - 1). A LiDAR that turns clockwise
// takes beam 0 last: its scans have the stamp of their end and a negative duration.
// A beam without return keeps its raw range and has is_valid[i] == 0: some systems need the raw
// value.
struct LaserScan {
  Timestamp stamp;  // of beam 0
  double angle_min_rad = 0;
  double angle_increment_rad = 0;
  double range_min_m = 0;
  double range_max_m = 0;  // the sensor's limit; a valid range is never longer
  double duration_s = 0;   // beam 0 to beam n - 1; 0 = all at once
  Pose2 T_base_lidar;
  std::vector<float> ranges_m;
  std::vector<std::uint8_t> is_valid;  // same length; 1 = a surface was hit

  [[nodiscard]] std::size_t num_beams() const { return ranges_m.size(); }
  [[nodiscard]] double angle_rad(std::size_t beam_index) const {
    return angle_min_rad + static_cast<double>(beam_index) * angle_increment_rad;
  }
  // Seconds after `stamp`.
  [[nodiscard]] double beam_time_s(std::size_t beam_index) const {
    return num_beams() < 2 ? 0.0
                           : duration_s * static_cast<double>(beam_index) /
                                 static_cast<double>(num_beams() - 1);
  }
  // End point of a beam in the base frame [m], as if the robot stood still during the sweep.
  [[nodiscard]] Eigen::Vector2d point_base_m(std::size_t beam_index) const {
    const double range_m = ranges_m[beam_index];
    const double angle = angle_rad(beam_index);
    return T_base_lidar * Eigen::Vector2d(range_m * std::cos(angle), range_m * std::sin(angle));
  }
};

}  // namespace corridor
