// The robot model as TOML: what a rawlog's leading comment and LOG.robot.toml hold.
// Tables [robot] [wheels] [lidar] [imu]; angles in degrees, all else SI; unknown keys are errors.
// LOG.robot.toml and the catalogue may add [raw] (raw_sensors.hpp) for logs of raw numbers.
#pragma once

#include <string>
#include <string_view>

#include "datasets/formats/raw_sensors.hpp"
#include "slam/core/result.hpp"
#include "slam/core/robot_model.hpp"

namespace corridor::formats {

// Every key, with as many digits as give back the same numbers.
std::string robot_to_toml(const RobotModel& robot);

// wheels.track_m, left_m_per_tick and right_m_per_tick are required. The Error lists every
// violation.
Result<RobotModel> robot_from_toml(std::string_view text, std::string_view where);

// What a text says about the sensors, to be laid over another model.
struct RobotOverride {
  RobotModel robot;                // `base` with the text's keys put in
  RawSensors raw;                  // as above
  bool states_wheels = false;      // track_m, left_m_per_tick and right_m_per_tick
  bool states_lidar_pose = false;  // any of lidar.x_m, y_m, yaw_deg
  bool states_range_max = false;
  bool states_range_min = false;
  bool states_range_sigma = false;
  bool states_scan_duration = false;
  bool states_imu_pose = false;  // any of imu.x_m, y_m, yaw_deg
};

// Nothing is required: keys that are not there keep the value of `base`.
Result<RobotOverride> override_robot(const RobotModel& base, std::string_view text,
                                     std::string_view where, const RawSensors& raw_base = {});

}  // namespace corridor::formats
