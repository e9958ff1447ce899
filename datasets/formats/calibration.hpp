// Which robot model a log is read with, when the log, its sidecar and the caller each say
// something. Internal to this folder.
#pragma once

#include <optional>
#include <string>

#include "datasets/formats/parsed_log.hpp"
#include "datasets/formats/robot_keys.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

struct CalibrationSources {
  std::optional<RobotModel> caller;         // ReadLogOptions::robot
  RobotKeys caller_keys;                    // ReadLogOptions::robot_keys
  std::optional<std::string> sidecar_toml;  // LOG.robot.toml
  std::string file;                         // for messages
  std::string sidecar_file;
};

// From weakest to strongest: defaults, the caller's model (only if the log has none), the log's own
// model, the sidecar key by key. Where beams point, how far they reach and where the IMU sits is
// taken from the readings themselves; a model that says otherwise is corrected with a note, a
// sidecar that says otherwise corrects the scans with a note. Sets each scan's range_min_m and
// duration_s (but for scans that state their own: their median becomes the model's). The keys are
// those that any of these sources states.
Result<StatedRobot> calibrate(ParsedLog& log, const CalibrationSources& sources,
                              std::vector<std::string>& notes);

}  // namespace corridor::formats
