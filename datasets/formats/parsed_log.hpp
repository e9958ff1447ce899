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

// What was done, and how often: "beams of range 0 taken as no return" -> 12.
using Counts = std::map<std::string, std::size_t>;

// A finite range that is no return, by the limit from which on there is none: every reader counts
// them here.
inline void count_no_return(double range_m, double limit_m, Counts& counts) {
  ++counts[range_m == 0 ? "beams of range 0 taken as no return"
           : range_m >= limit_m
               ? "beams at the LiDAR's limit or beyond taken as no return"
               : "beams below the LiDAR's limit that the log says are without return"];
}

// The standard deviation of a range as the scans state it, by every one of them or by none.
struct StatedNoise {
  std::optional<double> sigma_m;  // the first scan's
  bool varies = false;

  void take(double stated_m) {
    varies = varies || (sigma_m && *sigma_m != stated_m);
    if (!sigma_m) sigma_m = stated_m;
  }
  // Between the best of LiDARs and one that says nothing; formats write 0 where it is not known.
  static bool is_sensible(double stated_m) { return stated_m >= 1e-3 && stated_m <= 0.5; }
};

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
  // False where the scans' range_max_m is the model's, or one that is assumed.
  bool scans_state_range_max = true;
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
  StatedNoise stated_noise;
  // Wheel samples have ticks; their poses follow from them and the robot model.
  bool has_wheel_ticks_only = false;
  // Repairs.
  Counts counts;
  // What the file says and the log has no place for: no conversion brings it back.
  Counts left_out;
  // What else was done, one line each.
  std::vector<std::string> notes;

  void add(SensorEvent event, std::uint64_t origin) {
    events.push_back(std::move(event));
    origins.push_back(origin);
  }
};

}  // namespace corridor::formats
