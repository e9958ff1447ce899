// The robot model as TOML: what a rawlog's leading comment and LOG.robot.toml hold.
// Tables [robot] [wheels] [lidar] [imu]; angles in degrees, all else SI; unknown keys are errors.
// LOG.robot.toml and the catalogue may add [raw] (raw_sensors.hpp) for logs of raw numbers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "datasets/formats/raw_sensors.hpp"
#include "datasets/formats/robot_keys.hpp"
#include "slam/core/result.hpp"
#include "slam/core/robot_model.hpp"

namespace corridor::formats {

struct RobotEntry {
  std::string_view table;  // "wheels"
  std::string_view key;    // "track_m"
  std::string value;       // as TOML, with as many digits as give back the same number

  [[nodiscard]] std::string path() const;  // "wheels.track_m"
};

// Every value of a model, table by table.
std::vector<RobotEntry> robot_entries(const RobotModel& robot);

// The same as a document.
std::string robot_to_toml(const RobotModel& robot);

// wheels.track_m, left_m_per_tick and right_m_per_tick are required. The Error lists every
// violation, each with its line of `where`.
Result<StatedRobot> robot_from_toml(std::string_view text, std::string_view where);

// What a text says about the sensors, to be laid over another model.
struct RobotOverride {
  RobotModel robot;  // the base with the text's keys put in
  RobotKeys keys;    // the text's
  RawSensors raw;    // as `robot`
};

// Nothing is required: keys that are not there keep the value of `base`. Errors as above.
Result<RobotOverride> override_robot(const RobotModel& base, std::string_view text,
                                     std::string_view where, const RawSensors& raw_base = {});

}  // namespace corridor::formats
