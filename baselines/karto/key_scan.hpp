// A laser scan as Karto keeps it: beams in the sensor frame, and its place in the map.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "baselines/karto/valid_points.hpp"
#include "slam/core/scan.hpp"

namespace corridor::karto {

using KeyScanId = std::uint32_t;

struct KeyScanOptions {
  double range_threshold_m = 12;
  bool use_barycentre = true;
  // Beams without return have an end point at their raw range: they split surfaces where the valid
  // points are selected. As shipped.
  bool keep_no_returns = true;
};

// Beams with a valid range up to the threshold are "in range"; the others still have an end point
// if their raw range is finite, because the response counts them.
class KeyScan {
 public:
  KeyScan(const LaserScan& scan, const Pose2& T_odom_base, const KeyScanOptions& options);

  // Moves the scan: recomputes its end points and reference point in the map.
  void set_T_map_sensor(const Pose2& T_map_sensor);

  KeyScanId id = 0;

  [[nodiscard]] Timestamp stamp() const { return stamp_; }
  [[nodiscard]] const Pose2& T_base_sensor() const { return T_base_sensor_; }
  [[nodiscard]] const Pose2& T_odom_sensor() const { return T_odom_sensor_; }
  [[nodiscard]] const Pose2& T_map_sensor() const { return T_map_sensor_; }
  [[nodiscard]] Pose2 T_map_base() const { return T_map_sensor_ * T_base_sensor_.inverse(); }

  // End point per beam in the sensor frame; NaN where the raw range is not finite.
  [[nodiscard]] const std::vector<Eigen::Vector2d>& beams_sensor_m() const {
    return beams_sensor_m_;
  }
  [[nodiscard]] const std::vector<std::uint8_t>& is_in_range() const { return is_in_range_; }
  // 1 where the sensor saw a surface, even beyond the range threshold.
  [[nodiscard]] const std::vector<std::uint8_t>& is_return() const { return is_return_; }
  // End points of the beams in range, and of the others if kept, in order of the beams, map frame.
  [[nodiscard]] const PointColumns& points_map_m() const { return points_map_m_; }
  // Those points as pieces of surface, in the map.
  [[nodiscard]] const Surface& surface_map() const { return surface_map_; }
  // False if no beam is in range: there is nothing to match or to map.
  [[nodiscard]] bool is_usable() const { return num_in_range_ > 0; }
  // Where the scan "is" in every test of distance: the mean of its end points in range, or
  // the sensor.
  [[nodiscard]] const Eigen::Vector2d& reference_map_m() const { return reference_map_m_; }

 private:
  [[nodiscard]] bool has_point(std::size_t beam) const {
    return is_in_range_[beam] != 0 ||
           (options_.keep_no_returns && beams_sensor_m_[beam].allFinite());
  }

  Timestamp stamp_;
  Pose2 T_base_sensor_;
  Pose2 T_odom_sensor_;
  Pose2 T_map_sensor_;
  KeyScanOptions options_;
  Eigen::Index num_in_range_ = 0;
  Eigen::Index num_points_ = 0;
  std::vector<Eigen::Vector2d> beams_sensor_m_;
  std::vector<std::uint8_t> is_in_range_;
  std::vector<std::uint8_t> is_return_;
  PointColumns points_map_m_;
  Surface surface_map_;
  Eigen::Vector2d reference_map_m_ = Eigen::Vector2d::Zero();
};

}  // namespace corridor::karto
