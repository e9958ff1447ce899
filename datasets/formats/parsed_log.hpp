// What a log parser hands to read_log: events as they stand in the file, before order, calibration
// and defects are looked at.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "slam/core/sensor_log.hpp"

namespace corridor::formats {

// A beam count above this is a corrupted number, not a sensor; checked before anything is
// allocated.
inline constexpr std::size_t kMaxBeams = 65'536;

// A fan of more than a turn is degrees taken for radians, or a corrupted number.
inline bool exceeds_full_turn(std::size_t num_beams, double angle_increment_rad) {
  constexpr double kPrinted_rad = 1e-3;  // angles of few digits
  const double num_steps = num_beams < 2 ? 0 : static_cast<double>(num_beams - 1);
  return !(std::abs(angle_increment_rad) * num_steps <= 2 * std::numbers::pi + kPrinted_rad);
}

// A heading beyond this is no number of turns a robot makes, and has lost its digits.
inline constexpr double kMaxHeading_rad = 1e6;

struct ParsedLog {
  std::vector<SensorEvent> events;
  // Where in the file each event stands: a line number (CARMEN) or a byte offset (rawlog, ROS bag).
  std::vector<std::uint64_t> origins;
  std::string origin_unit;  // "line", "byte"
  std::string format;       // as in Provenance
  // The robot model that the log carries, and where.
  std::optional<std::string> robot_toml;
  // False for FLASER lines, which do not say where the LiDAR sits.
  bool scans_state_pose = true;
  // True for logs with a moment for each beam: the scans' duration_s stands, the model's follows.
  bool scans_state_duration = false;
  // True where scans were turned round to be counter-clockwise: without a moment for each beam
  // their stamp is still that of the beam that is last now.
  bool has_clockwise_scans = false;
  // True if the scans' stamps lie on the wheels' clock already: nothing is left of
  // lidar.time_offset_s.
  bool is_time_offset_applied = false;
  // Poses that another program found while the log was recorded: a reference, not truth.
  std::optional<Trajectory> reference;
  // Where the log places its IMU.
  std::optional<Pose2> T_base_imu;
  // What the log says of its scans besides their range_max_m.
  std::optional<double> range_min_m;
  // Wheel samples have ticks; their poses follow from them and the robot model.
  bool has_wheel_ticks_only = false;
  // Counted repairs and things left out, by what was done: "beams of range 0 taken as no return"
  // -> 12.
  std::map<std::string, std::size_t> counts;
  // What else was done, one line each.
  std::vector<std::string> notes;

  void add(SensorEvent event, std::uint64_t origin) {
    events.push_back(std::move(event));
    origins.push_back(origin);
  }
};

}  // namespace corridor::formats
