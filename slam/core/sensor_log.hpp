// A recording: robot model, events in time order, truth where it is known, and where it came from.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "slam/core/imu.hpp"
#include "slam/core/result.hpp"
#include "slam/core/robot_model.hpp"
#include "slam/core/scan.hpp"
#include "slam/core/trajectory.hpp"
#include "slam/core/wheel.hpp"

namespace corridor {

using SensorEvent = std::variant<LaserScan, WheelSample, ImuSample>;

Timestamp stamp_of(const SensorEvent& event);

// What makes one event unfit by itself: values that are not finite, a scan without beams or whose
// arrays differ in length, a valid range outside (0, range_max_m]. nullopt: nothing.
std::optional<std::string> defect_of(const SensorEvent& event);

struct Provenance {
  std::string name;    // data set's name, or the file's
  std::string source;  // path of the file, or "simulated"
  std::string format;  // "rawlog", "carmen", "simulation"
  std::vector<std::string>
      notes;  // counted, reported repairs: "12 stamps moved by isotonic regression"
  // The file says more than the log holds; notes name what.
  bool has_left_out = false;
  // The log's truth is what another program found while it was recorded.
  bool is_truth_reference = false;
};

struct SensorLog {
  RobotModel robot;
  std::vector<SensorEvent>
      events;  // stamps never decrease; equal stamps of different sensors allowed
  std::optional<Trajectory> truth;  // T_map_base at (at least) each scan
  Provenance provenance;

  [[nodiscard]] std::size_t num_scans() const;
  [[nodiscard]] std::size_t num_wheel_samples() const;
  [[nodiscard]] std::size_t num_imu_samples() const;
  // Last stamp minus first [s]; 0 for fewer than two events.
  [[nodiscard]] double duration_s() const;
};

struct LogLimits {
  // Between consecutive events of one sensor, or between its first or last and the log's.
  double max_gap_s = 10.0;
  double max_speed_mps = 10.0;       // of the wheel odometry; faster means wrong units or stamps
  double max_yaw_rate_radps = 20.0;  // of wheels and gyro
  // Both of the wheels are means over as many steps as last this long together: stamps that nearly
  // coincide say nothing about speed. The rest of a log behind its last full window, and the whole
  // of a shorter log, may be as long as max_speed_mps allows in its own time and max_jump_m more,
  // and turn as far as max_yaw_rate_radps allows in a full window.
  double speed_window_s = 0.2;
  double max_jump_m = 0.5;               // one step of the wheels, besides what the speed allows
  double max_acceleration_mps2 = 200.0;  // 20 g: more than sensors of robots measure
};

// Every defect that makes the log unfit, one line each, with the event's index: empty log, no scan,
// stamps that step back or repeat within a sensor, gaps, a sensor that begins late or ends early,
// non-finite values, beam counts that change or differ between arrays, a valid range outside the
// sensor's limits, impossible speeds and accelerations, a robot model that breaks its rules. At
// most `max_lines` lines. Nothing is repaired.
std::vector<std::string> defects(const SensorLog& log, const LogLimits& limits = {},
                                 std::size_t max_lines = 20);

}  // namespace corridor
