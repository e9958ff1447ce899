// The table [family] of a scenario file: one scenario for each value of a key. Internal to this
// folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "slam/core/result.hpp"

namespace corridor::simulation {

struct Family {
  std::string key;  // "lidar.range_max_m", or "imu.preset"
  std::vector<std::string> values;

  [[nodiscard]] std::string section() const;
  [[nodiscard]] bool is_of_presets() const;
};

// nullopt: a plain scenario. Unknown keys, values that are neither numbers nor names and values
// that stand there twice are errors.
Result<std::optional<Family>> read_family(const std::filesystem::path& path);

}  // namespace corridor::simulation
