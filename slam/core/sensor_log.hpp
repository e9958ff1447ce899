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
  double max_gap_s = 10.0;      // between consecutive events of one sensor; longer is an error
  double max_speed_mps = 10.0;  // of the wheel odometry; faster means wrong units or stamps
  double max_yaw_rate_radps = 20.0;
};

// Every defect that makes the log unfit, one line each, with the event's index: empty log, no scan,
// stamps that step back or repeat within a sensor, gaps, non-finite values, beam counts that change
// or differ between arrays, a valid range outside the sensor's limits, impossible speeds, a robot
// model that breaks its rules. At most `max_lines` lines. Nothing is repaired.
std::vector<std::string> defects(const SensorLog& log, const LogLimits& limits = {},
                                 std::size_t max_lines = 20);

}  // namespace corridor
