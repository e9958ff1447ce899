#include "tests/fuzz/settle.hpp"

#include <utility>
#include <vector>

#include "datasets/formats/calibration.hpp"
#include "datasets/formats/stamp_order.hpp"
#include "datasets/formats/tick_odometry.hpp"
#include "slam/core/sensor_log.hpp"

namespace corridor::fuzz {
namespace {

void finish(formats::ParsedLog parsed, const std::optional<std::string>& sidecar_toml) {
  formats::CalibrationSources sources;
  sources.sidecar_toml = sidecar_toml;
  sources.file = "log";
  sources.sidecar_file = "log.robot.toml";
  std::vector<std::string> notes;
  const auto robot = formats::calibrate(parsed, sources, notes);
  if (!robot) return;
  SensorLog log;
  log.robot = *robot;
  log.events = std::move(parsed.events);
  if (parsed.has_wheel_ticks_only &&
      !formats::integrate_wheel_ticks(log.events, log.robot.wheels, "log")) {
    return;
  }
  defects(log, LogLimits{});
}

}  // namespace

void settle(const formats::ParsedLog& parsed, const std::optional<std::string>& sidecar_toml) {
  if (formats::check_stamp_order(parsed, "log")) finish(parsed, sidecar_toml);
  formats::ParsedLog in_file_order = parsed;
  formats::make_stamps_increase(in_file_order.events);
  finish(std::move(in_file_order), sidecar_toml);
}

}  // namespace corridor::fuzz
