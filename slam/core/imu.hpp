// One reading of an inertial measurement unit, reduced to the plane.
#pragma once

#include "slam/core/timestamp.hpp"

namespace corridor {

// In the IMU frame, which RobotModel places on the base. Specific force, so that a robot at rest on
// a level floor reads zero in x and y.
struct ImuSample {
  Timestamp stamp;
  double gyro_z_radps = 0;
  double accel_x_mps2 = 0;
  double accel_y_mps2 = 0;
};

}  // namespace corridor
