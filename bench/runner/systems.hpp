// The one table of everything that can be run: systems with their profiles, parameters and
// factories. It is a function, not a registry: a new rival is one more entry in systems.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/runner/graph_task.hpp"
#include "slam/core/params.hpp"
#include "slam/core/result.hpp"
#include "slam/core/robot_model.hpp"
#include "slam/core/sensor_log.hpp"
#include "slam/core/slam_system.hpp"

namespace corridor::runner {

// A named parameter set of a system.
struct ProfileInfo {
  std::string name;
  std::string description;
};

// What becomes of a system's back-end before the system has it.
using WrapBackEnd =
    std::function<std::unique_ptr<backend::BackEnd>(std::unique_ptr<backend::BackEnd>)>;

struct SystemRequest {
  std::string profile;
  ParamValues overrides;               // on top of the profile
  std::optional<std::string> backend;  // for systems that take one
  RobotModel robot;
  std::uint64_t seed = 1;
  int threads = 1;
  ParamValues backend_overrides = {};  // on top of what the back-end has
  WrapBackEnd wrap_back_end = {};      // empty: nothing
};

struct SystemInfo {
  std::string name;
  std::string description;
  std::vector<ProfileInfo> profiles;           // the first is the default
  std::optional<std::string> default_backend;  // none: takes no back-end
  bool needs_wheels = false;  // without them it would leave the robot where it starts
  bool needs_imu = false;
  bool is_stochastic = false;  // another seed gives another estimate

  // Every parameter with unit, range, meaning and the profile's value.
  std::function<std::vector<ParamRow>(const std::string& profile)> param_table;
  // Every parameter's value. The Error lists all unknown names and broken rules.
  std::function<Result<ParamValues>(const std::string& profile, const ParamValues& overrides)>
      resolve;
  // Of systems that are given a log; empty for those that are given a pose graph.
  std::function<Result<std::unique_ptr<SlamSystem>>(const SystemRequest&)> make;
  // Of systems that are given a pose graph.
  std::function<Result<GraphTask>(const std::string& profile, const ParamValues& overrides)>
      graph_task;

  [[nodiscard]] bool takes_graphs() const { return graph_task != nullptr; }
  [[nodiscard]] bool has_profile(std::string_view profile) const;
};

// The sensors that not every log has; without scans no log is of use to anybody.
struct LogSensors {
  bool has_wheels = true;
  bool has_imu = true;
};

LogSensors sensors_of(const SensorLog& log);

// What the system needs and such a log does not have: "wheels", "an IMU".
std::optional<std::string> missing_sensor(const SystemInfo& info, const LogSensors& sensors);

// In the order of tables: the floor, the rivals, the third-party references, the fusion systems,
// what solves graphs.
std::vector<SystemInfo> systems();

// "unknown system X; expected one of: ..." in one line, likewise for a profile and a back-end.
Result<SystemInfo> find_system(std::string_view name);

// A system as the command line and suites name it: NAME or NAME@PROFILE.
struct SystemChoice {
  std::string system;
  std::string profile;

  bool operator==(const SystemChoice&) const = default;
};
// Without @PROFILE: the system's default profile.
Result<SystemChoice> parse_system_choice(std::string_view text);

}  // namespace corridor::runner
