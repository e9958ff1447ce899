// LCM event logs of the mbot robot: LiDAR, wheel encoders, IMU and the poses of its own SLAM.
// Internal to this folder; log_io.hpp is the door.
//
// Written here, without liblcm: its reader takes files only (these are compressed), skips over what
// is broken and decodes nothing without generated code; what is left to do over checked bytes is
// four messages of fixed layout (mbot_messages.hpp).
#pragma once

#include <string>
#include <string_view>

#include "datasets/formats/parsed_log.hpp"
#include "datasets/formats/raw_sensors.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

struct LcmOptions {
  RawSensors raw;
  RobotModel robot;  // wheels turn ticks into odometry; lidar.range_max_m is the limit of a return
};

// Scans are put into a uniform fan (uniform_fan.hpp), ticks into odometry (tick_odometry.hpp), IMU
// readings into SI units of axes x, y and z up. Sensors arrive with different delays: their
// readings are merged by stamp, each sensor's own order kept. What is changed or left out is
// counted.
Result<ParsedLog> parse_lcm(std::string_view bytes, const std::string& file,
                            const LcmOptions& options);

}  // namespace corridor::formats
