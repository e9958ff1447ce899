#include "baselines/gmapping/scan_points.hpp"

#include <cmath>

#include "slam/core/expect.hpp"

namespace corridor::gmapping {

ScanPoints usable_points(const LaserScan& scan, const BeamSelection& selection) {
  CORRIDOR_EXPECT(selection.stride >= 1);
  const double tilt_rad = selection.tilt_steps * scan.angle_increment_rad;
  ScanPoints points;
  points.x_base_m.reserve(scan.num_beams());
  points.y_base_m.reserve(scan.num_beams());
  points.beam_x_base.reserve(scan.num_beams());
  points.beam_y_base.reserve(scan.num_beams());
  const Eigen::Matrix2d R_base_lidar = scan.T_base_lidar.rotation();
  for (std::size_t i = 0; i < scan.num_beams(); i += static_cast<std::size_t>(selection.stride)) {
    const double range_m = scan.ranges_m[i];
    if (scan.is_valid[i] == 0 || !(range_m > 0 && range_m <= selection.max_range_m)) continue;
    const double angle_rad = scan.angle_rad(i) + tilt_rad;
    const Eigen::Vector2d beam_lidar(std::cos(angle_rad), std::sin(angle_rad));
    const Eigen::Vector2d point_base_m =
        scan.T_base_lidar * Eigen::Vector2d(range_m * beam_lidar.x(), range_m * beam_lidar.y());
    const Eigen::Vector2d beam_base = R_base_lidar * beam_lidar;
    points.x_base_m.push_back(static_cast<float>(point_base_m.x()));
    points.y_base_m.push_back(static_cast<float>(point_base_m.y()));
    points.beam_x_base.push_back(static_cast<float>(beam_base.x()));
    points.beam_y_base.push_back(static_cast<float>(beam_base.y()));
  }
  return points;
}

}  // namespace corridor::gmapping
