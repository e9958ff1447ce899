// A scenario file with another preset than it names: what a family of sensors needs. Internal to
// this folder.
#pragma once

#include <string>

#include "datasets/simulation/scenario.hpp"

namespace corridor::simulation {

// "imu", "consumer"; no section: as the file says.
struct SensorPreset {
  std::string section, name;
};

// The preset takes the place of the one that the file names in that section; keys that the file
// sets itself stay. An unknown section is not looked at.
Result<Scenario> read_scenario(const std::filesystem::path& path, const SensorPreset& preset);

// Whether presets/sensors.toml has any for this section.
bool has_presets(const std::string& section);

}  // namespace corridor::simulation
