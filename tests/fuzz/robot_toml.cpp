// The robot model as TOML: complete, as in a log, and as a sidecar. A model that was read can be
// written and read again.
#include "datasets/formats/robot_toml.hpp"

#include "slam/core/expect.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool robot_toml(std::string_view bytes) {
  const auto stated = formats::override_robot(RobotModel{}, bytes, "log.robot.toml");
  const auto complete = formats::robot_from_toml(bytes, "log");
  if (!complete) return stated.has_value();
  const auto again = formats::robot_from_toml(formats::robot_to_toml(complete->robot), "log");
  CORRIDOR_EXPECT(again.has_value() && again->robot.name == complete->robot.name);
  return true;
}

}  // namespace corridor::fuzz
