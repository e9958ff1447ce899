// The report of `data inspect` as JSON and as text. It computes nothing.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "datasets/formats/log_health.hpp"
#include "datasets/formats/robot_keys.hpp"
#include "slam/core/sensor_log.hpp"

namespace corridor::cli {

struct LogReport {
  const SensorLog* log = nullptr;
  const formats::LogHealth* health = nullptr;
  const formats::RobotKeys* robot_keys = nullptr;  // what is stated of the robot model
  double applied_time_offset_s = 0;                // was lidar.time_offset_s
  std::optional<std::size_t> num_relations;
};

// Every key is always there, null where it does not apply; units are in the names.
nlohmann::ordered_json to_json(const LogReport& report);

std::string to_text(const LogReport& report);

}  // namespace corridor::cli
