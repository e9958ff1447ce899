#include "slam/motion/deskew.hpp"

namespace corridor::motion {

std::vector<Eigen::Vector2d> deskewed_points(const LaserScan& scan,
                                             const Eigen::Vector3d& twist_base,
                                             double max_range_m) {
  std::vector<Eigen::Vector2d> points_base;
  points_base.reserve(scan.num_beams());
  for (std::size_t i = 0; i < scan.num_beams(); ++i) {
    if (!scan.is_valid[i] || !(static_cast<double>(scan.ranges_m[i]) <= max_range_m)) continue;
    const Eigen::Vector2d point = scan.point_base_m(i);
    points_base.push_back(
        scan.duration_s != 0 ? Eigen::Vector2d(Pose2::exp(twist_base * scan.beam_time_s(i)) * point)
                             : point);
  }
  return points_base;
}

}  // namespace corridor::motion
