// The floor every system must beat: the wheels alone, or the wheels' path with the gyro's heading.
// [Thrun2005] section 5.4 (odometry). It has no map and corrects nothing.
#pragma once

#include <memory>

#include "slam/core/params.hpp"
#include "slam/core/robot_model.hpp"
#include "slam/core/slam_system.hpp"

namespace corridor::dead_reckoning {

struct DeadReckoningParams {
  bool use_gyro = false;
  double standstill_distance_m = 0.001;  // wheels that moved less since the start stand still
  int min_standstill_samples = 20;       // fewer give no bias: zero is assumed

  template <class V>
  static void visit(DeadReckoningParams& p, V&& v) {
    v(ParamInfo{"use_gyro", "", "heading from the gyro instead of the wheels"}, p.use_gyro);
    v(ParamInfo{"standstill_distance_m", "m",
                "travel below which the robot counts as not started yet", 0, 1},
      p.standstill_distance_m);
    v(ParamInfo{"min_standstill_samples", "1", "gyro readings at standstill needed for a bias", 1,
                100000},
      p.min_standstill_samples);
  }
};

// name(): "dead-reckoning", with the gyro "dead-reckoning-gyro". With use_gyro a scan before any
// IMU reading is an Error: the log has no gyro. A scan without a wheel sample near it keeps the
// last pose.
std::unique_ptr<SlamSystem> make_dead_reckoning(const DeadReckoningParams& params,
                                                const RobotModel& robot);

}  // namespace corridor::dead_reckoning
