// A scenario: everything that decides a simulated run except its seed, as a TOML file.
// One parameter struct per cause; the defaults here are the suite's robot in the paper's corridor.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/simulation/scenario_params.hpp"
#include "datasets/simulation/sensor_params.hpp"
#include "datasets/simulation/world.hpp"
#include "slam/core/params.hpp"
#include "slam/core/result.hpp"
#include "slam/core/robot_model.hpp"

namespace corridor::simulation {

struct Scenario {
  std::string name = "paper-corridor";
  std::string description;
  World world = make_corridor({});
  LidarParams lidar;
  WheelParams wheels;
  ImuParams imu;
  DriveParams drive;
  SlipParams slip;
  OutageParams outages;
  DrawParams draw;
  PeopleParams people;
};

// All rules broken, one line each, keys as "lidar.range_max_m"; empty = can be simulated.
std::vector<std::string> violations(const Scenario& scenario);

// Reads a scenario. Keys not given keep their defaults, or the values of the scenario that the key
// `base` names; a sensor's table may name a `preset` of datasets/scenarios/presets/sensors.toml,
// whose values come before its own keys. [world] holds the corridor's keys or a drawing
// (world.hpp), or names `map`, the yaml file of a ROS map beside the scenario, and a `route_m`
// through it. The corridor's keys change those of the base one by one; a drawing or map takes the
// place of the base's, and a `route_m` alone is another way through it. A `name` is that of the
// file. On failure the Error lists ALL unknown keys, wrong types and broken rules, each with
// its line.
Result<Scenario> read_scenario(const std::filesystem::path& path);

// Sets values by key, as "lidar.range_max_m" -> "6.0" or "world.alpha_deg" -> "80", and checks all.
Result<Scenario> with_overrides(Scenario scenario, const ParamValues& overrides,
                                std::string_view where);

// Every value by key: what a result record stores.
ParamValues scenario_values(const Scenario& scenario);
// The same with unit, range and meaning, in the order of a file; [world] only of the corridor.
std::vector<ParamRow> scenario_table(const Scenario& scenario);

// The scenario files of datasets/scenarios/, sorted by name.
std::vector<std::filesystem::path> list_scenarios();
// The file of a scenario's name ("paper-corridor"), or the path itself if it names a file. The part
// from the last '@' on, which names a member of a family, is not looked at.
Result<std::filesystem::path> find_scenario(const std::string& name_or_path);
// The name or path without that part.
std::string without_member(const std::string& name_or_path);

// A family is a scenario with the table [family]: key = "lidar.range_max_m", values = [3.5, 4.5],
// or key = "imu.preset", values = ["industrial", "consumer"]. Its members are called NAME@VALUE,
// each the scenario with that value or with that preset under the file's own keys. The members of a
// family, as names to load; a plain scenario is its own only member.
Result<std::vector<std::string>> scenario_members(const std::string& name_or_path);
// A scenario or a member by name or path. A family itself is an Error that names its members.
Result<Scenario> load_scenario(const std::string& name_or_path);

// What the log states about the robot: the nominal calibration, without any drawn error.
RobotModel nominal_robot(const Scenario& scenario);

}  // namespace corridor::simulation
