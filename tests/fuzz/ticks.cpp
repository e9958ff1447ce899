// Logs of raw ticks: the calibration's TOML, the separator, the log.
#include "datasets/formats/ticks.hpp"

#include "datasets/formats/robot_toml.hpp"
#include "tests/fuzz/inputs.hpp"
#include "tests/fuzz/settle.hpp"
#include "tests/fuzz/targets.hpp"

namespace corridor::fuzz {

bool ticks(std::string_view bytes) {
  const auto [toml, log] = split(bytes);
  const auto stated = formats::override_robot(RobotModel{}, toml, "log.robot.toml");
  if (!stated) return false;
  const auto parsed = formats::parse_ticks(log, "log.dat", stated->robot, stated->raw.clock);
  if (!parsed) return false;
  settle(*parsed, std::string(toml));
  return true;
}

}  // namespace corridor::fuzz
