// Takes the robot's motion during a sweep out of its points.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "slam/core/scan.hpp"

namespace corridor::motion {

// End points of the valid beams up to max_range_m, in the base frame at the scan's stamp [m].
// twist_base: motion of the base per second, (x [m/s], y [m/s], theta [rad/s]), constant over the
// sweep: p = Exp(twist * t_beam) * p_at_beam_time.
std::vector<Eigen::Vector2d> deskewed_points(const LaserScan& scan,
                                             const Eigen::Vector3d& twist_base, double max_range_m);

}  // namespace corridor::motion
