#include "tests/fuzz/settle.hpp"

#include <utility>
#include <vector>

#include "datasets/formats/calibration.hpp"
#include "datasets/formats/stamp_order.hpp"
#include "datasets/formats/tick_odometry.hpp"
#include "slam/core/expect.hpp"
#include "slam/core/sensor_log.hpp"

namespace corridor::fuzz {
namespace {

std::optional<SensorLog> finish(formats::ParsedLog parsed,
                                const std::optional<std::string>& sidecar_toml) {
  formats::CalibrationSources sources;
  sources.sidecar_toml = sidecar_toml;
  sources.file = "log";
  sources.sidecar_file = "log.robot.toml";
  std::vector<std::string> notes;
  const auto stated = formats::calibrate(parsed, sources, notes);
  if (!stated) return std::nullopt;
  SensorLog log;
  log.robot = stated->robot;
  log.events = std::move(parsed.events);
  if (parsed.has_wheel_ticks_only &&
      !formats::integrate_wheel_ticks(log.events, log.robot.wheels, "log")) {
    return std::nullopt;
  }
  if (!defects(log).empty()) return std::nullopt;
  return log;
}

}  // namespace

std::vector<SensorLog> settle(const formats::ParsedLog& parsed,
                              const std::optional<std::string>& sidecar_toml) {
  std::vector<SensorLog> fit;
  const auto keep = [&fit](std::optional<SensorLog> log) {
    if (log) fit.push_back(std::move(*log));
  };
  if (formats::check_stamp_order(parsed, "log")) keep(finish(parsed, sidecar_toml));
  formats::ParsedLog in_file_order = parsed;
  formats::make_stamps_increase(in_file_order.events);
  keep(finish(std::move(in_file_order), sidecar_toml));
  return fit;
}

void expect_same_readings(const SensorLog& log, const Result<formats::ParsedLog>& again,
                          bool holds_all) {
  if (!again) return;
  SensorLog read;
  read.events = again->events;
  CORRIDOR_EXPECT(read.num_scans() == log.num_scans());
  CORRIDOR_EXPECT(read.num_wheel_samples() >= log.num_wheel_samples());
  CORRIDOR_EXPECT(!holds_all || read.events.size() == log.events.size());
}

}  // namespace corridor::fuzz
