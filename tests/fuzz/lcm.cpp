// LCM event logs, framing and messages: the calibration's TOML, the separator, the log.
#include "datasets/formats/lcm/lcm.hpp"

#include "datasets/formats/robot_toml.hpp"
#include "tests/fuzz/inputs.hpp"
#include "tests/fuzz/settle.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool lcm(std::string_view bytes) {
  const auto [toml, log] = split(bytes);
  const auto stated = formats::override_robot(RobotModel{}, toml, "log.robot.toml");
  if (!stated) return false;
  const auto parsed = formats::parse_lcm(log, "log.lcm", {stated->raw, stated->robot});
  if (!parsed) return false;
  settle(*parsed, std::string(toml));
  return true;
}

}  // namespace corridor::fuzz
