// The robot model as a table of a TOML document that is parsed already: the door behind
// robot_toml.hpp, for those whose document holds more. Internal to datasets/: it shows the TOML
// library, so only .cpp files include it.
#pragma once

#include <toml++/toml.h>

#include <string_view>
#include <vector>

#include "datasets/formats/robot_toml.hpp"
#include "datasets/formats/toml_problems.hpp"

namespace corridor::formats {

// kComplete: the model that a log carries. It states the wheels and speaks in SI units: no [raw].
// kOverride: what is laid over another model. Nothing is required.
enum class RobotTables { kComplete, kOverride };

// Tables [robot] [wheels] [lidar] [imu] [raw] laid over `base`, whose keys they join. Problems
// name keys by their path below `parent`, where the document has the tables ("calibration"; "" =
// its root).
RobotOverride read_robot_table(const toml::table& tables, std::string_view parent, RobotTables kind,
                               RobotOverride base, std::vector<TomlProblem>& problems);

}  // namespace corridor::formats
