// A scenario: everything that decides a simulated run except its seed, as a TOML file.
// One parameter struct per cause; the defaults here are the suite's robot in the paper's corridor.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/simulation/scenario_params.hpp"
#include "datasets/simulation/world.hpp"
#include "slam/core/params.hpp"
#include "slam/core/result.hpp"
#include "slam/core/robot_model.hpp"

namespace corridor::simulation {

struct Scenario {
  std::string name = "paper-corridor";
  std::string description;
  CorridorShape world;
  LidarParams lidar;
  WheelParams wheels;
  ImuParams imu;
  DriveParams drive;
  SlipParams slip;
  DrawParams draw;
};

// All rules broken, one line each, keys as "lidar.range_max_m"; empty = can be simulated.
std::vector<std::string> violations(const Scenario& scenario);

// Reads a scenario. Keys not given keep their defaults. On failure the Error lists ALL unknown
// keys, wrong types and broken rules, each with its line.
Result<Scenario> read_scenario(const std::filesystem::path& path);

// Sets values by key, as "lidar.range_max_m" -> "6.0" or "world.alpha_deg" -> "80", and checks all.
Result<Scenario> with_overrides(Scenario scenario, const ParamValues& overrides,
                                std::string_view where);

// Every value by key: what a result record stores.
ParamValues scenario_values(const Scenario& scenario);

// The scenario files of datasets/scenarios/, sorted by name.
std::vector<std::filesystem::path> list_scenarios();
// The file of a scenario's name ("paper-corridor"), or the path itself if it names a file.
Result<std::filesystem::path> find_scenario(const std::string& name_or_path);

// What the log states about the robot: the nominal calibration, without any drawn error.
RobotModel nominal_robot(const Scenario& scenario);

}  // namespace corridor::simulation
