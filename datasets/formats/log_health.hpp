// What a log holds and what is wrong with it, counted: the report behind `data inspect`.
// It repairs nothing and refuses nothing; corridor::defects() says what makes a log unfit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "slam/core/sensor_log.hpp"

namespace corridor::formats {

// Where events stand in their file, for messages; empty for logs that come from none.
struct EventPlaces {
  std::vector<std::uint64_t> origins;  // of each event
  std::string unit;                    // "line", "byte"

  // "line 12", or "event 5" where no file is known.
  [[nodiscard]] std::string of(std::size_t event_index) const;
  // A line of corridor::defects() with the place in the file: "event 5: ..." -> "line 12, event 5:
  // ...".
  [[nodiscard]] std::string placed(std::string defect) const;
};

// Stamps of one sensor in the order of the log.
struct StampHealth {
  std::size_t num_readings = 0;
  double first_s = 0;
  double last_s = 0;
  double median_step_s = 0;  // of the steps that go ahead; 0: there is none
  double longest_gap_s = 0;
  std::string longest_gap_at;   // the reading after it
  std::size_t num_gaps = 0;     // steps of more than five median steps
  std::size_t num_repeats = 0;  // stamps equal to the one before
  std::size_t num_back = 0;     // stamps before the one before
  std::string first_bad_at;     // the first of the last two kinds

  [[nodiscard]] double median_rate_hz() const { return median_step_s > 0 ? 1 / median_step_s : 0; }
};

struct LidarHealth {
  std::size_t min_beams = 0;
  std::size_t max_beams = 0;
  double field_of_view_rad = 0;  // first to last beam of the first scan
  double invalid_ratio = 0;      // beams without return
  double min_range_m = 0;        // of beams with a return
  double median_range_m = 0;
  double max_range_m = 0;
  double range_limit_m = 0;  // the sensor's, as the scans state it
  // The one value that most returns beyond three medians have, and their share of all returns: no
  // surface is at exactly one distance, codes for "no return" are.
  double most_shared_range_m = 0;
  double most_shared_ratio = 0;
  std::size_t num_most_shared = 0;
  std::string longest_range_at;
  // Of successive scans that are exactly the same, the run in which the wheels get farthest.
  std::size_t num_frozen_scans = 0;
  double frozen_path_m = 0;
  double frozen_turn_rad = 0;
  std::string frozen_until;
};

struct WheelHealth {
  bool has_ticks = false;
  double path_m = 0;    // sum of the steps
  double turn_rad = 0;  // sum of the steps' turns, both directions counted as positive
  // Over 0.2 s or a step, whichever is longer, or over a log that is shorter; nullopt where no time
  // passes. So is the next.
  std::optional<double> max_speed_mps;
  std::string max_speed_at;
  std::optional<double> max_yaw_rate_radps;
  std::string max_yaw_rate_at;
  std::size_t num_jumps = 0;  // steps faster than LogLimits
  // Of chords of the path, their share across the heading (|sin| of the angle between), on average:
  // 0 for wheels that roll, 2 / pi for headings that say nothing of the way.
  double sideways_ratio = 0;
  std::size_t num_chords = 0;
};

struct ImuHealth {
  double max_gyro_radps = 0;  // of the absolute values
  std::string max_gyro_at;
  double median_accel_x_mps2 = 0;
  double median_accel_y_mps2 = 0;
  // Turns over windows of a second in which the wheels turn by 0.05 rad or more, each counted in
  // the wheels' direction, less the gyro's mean while the wheels rest; nullopt if the wheels turn
  // by less than half a radian in all of them.
  std::optional<double> gyro_turn_rad;
  std::optional<double> wheel_turn_rad;
};

struct TruthHealth {
  std::size_t num_poses = 0;
  double path_m = 0;
  double scans_with_pose_ratio = 0;  // a true pose within 10 ms
  std::size_t num_fast_steps = 0;    // faster than LogLimits
  double first_fast_step_s = 0;      // stamp of the pose after it
  // Of truth and wheels between the same times, a second or more apart; 0 without wheels.
  double common_path_m = 0;
  double common_wheel_path_m = 0;
};

struct LogHealth {
  double duration_s = 0;
  StampHealth lidar_stamps, wheel_stamps, imu_stamps;
  std::optional<LidarHealth> lidar;
  std::optional<WheelHealth> wheels;
  std::optional<ImuHealth> imu;
  std::optional<TruthHealth> truth;
  std::vector<std::string> defects;  // what makes the log unfit, each with its place
  std::vector<std::string>
      suspicions;  // what looks wrong: units, axes, clocks (log_suspicions.hpp)
};

// Any log, fit or not. `defects` has at most `max_defects` lines.
LogHealth examine(const SensorLog& log, const EventPlaces& places = {},
                  const LogLimits& limits = {}, std::size_t max_defects = 1000);

}  // namespace corridor::formats
