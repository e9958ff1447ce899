// A scan that became a state of the factor graph. Its number is its index in the list of key scans.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "slam/core/scan.hpp"

namespace corridor::fusion {

struct KeyScan {
  LaserScan scan;
  std::vector<Eigen::Vector2d> points_base_m;  // deskewed, valid, within the used range
  bool is_trusted = true;  // no direction of its match was outvoted, nor was it refused
  double path_m = 0;       // travelled by the estimate up to here
  // Motion during the sweep, for the map: (x [m/s], y [m/s], theta [rad/s]) in base.
  Eigen::Vector3d twist_base = Eigen::Vector3d::Zero();
};

}  // namespace corridor::fusion
