// Poses of wheel samples that have ticks only. Internal to this folder.
#pragma once

#include <vector>

#include "slam/core/robot_model.hpp"
#include "slam/core/sensor_log.hpp"

namespace corridor::formats {

// T_odom_base along arcs of constant curvature, the first at the identity: with wheel paths l and r
// since the last sample, T_odom_base *= Exp((l + r) / 2, 0, (r - l) / track). Every wheel sample of
// `events` must have ticks.
void integrate_wheel_ticks(std::vector<SensorEvent>& events, const WheelModel& wheels);

}  // namespace corridor::formats
