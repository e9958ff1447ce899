// CARMEN text logs: FLASER, ROBOTLASER1, ODOM. Internal to this folder; log_io.hpp is the door.
//   FLASER n r_1..r_n  x y theta  odom_x odom_y odom_theta  ipc_stamp host logger_stamp
//   ROBOTLASER1 laser_type start_angle fov angular_res max_range accuracy remission_mode n r_1..r_n
//     num_remissions e_1..  laser(3) robot(3)  tv rv forward_safety side_safety turn_axis  stamp
//     host logger_stamp
//   ODOM x y theta tv rv accel  stamp host logger_stamp
// Other messages of the CARMEN vocabulary are skipped and counted; anything else is an error.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/formats/parsed_log.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

// Messages that a CARMEN log may hold and that say nothing the suite uses.
inline constexpr std::array<std::string_view, 18> kSkippedCarmenMessages = {
    "PARAM",     "SYNC",      "RLASER",    "LASER3",    "LASER4",    "ROBOTLASER2",
    "RAWLASER1", "RAWLASER2", "RAWLASER3", "RAWLASER4", "RAWLASER5", "TRUEPOS",
    "NMEAGGA",   "NMEARMC",   "SONAR",     "SONARPOS",  "BUMPER",    "GPGGA"};

inline bool is_skipped_carmen_message(std::string_view name) {
  return std::find(kSkippedCarmenMessages.begin(), kSkippedCarmenMessages.end(), name) !=
         kSkippedCarmenMessages.end();
}

// For lines that are left out whole: whether FLASER, ROBOTLASER1 or ODOM with a number behind it
// begins within `fields`, those behind the line's own message. A line whose end was lost would take
// the next one along unseen. The Error says so.
Result<void> check_one_message(std::string_view fields, const std::string& where);

struct CarmenOptions {
  // No return at or beyond this range. Without it ROBOTLASER1 lines use their own max_range.
  std::optional<double> no_return_range_m;
  // For FLASER lines, which state none.
  double flaser_range_max_m = 0;
};

// FLASER beams cover 180 degrees: beam i at -90 deg + i * 180/n (n even: 180, 360) or
// -90 deg + i * 180/(n - 1) (n odd: 181, 361). Each laser line gives the wheel pose first, then the
// scan, with the line's first stamp; the pose is left out if the event before says the same.
Result<ParsedLog> parse_carmen(std::string_view text, const std::string& file,
                               const CarmenOptions& options);

// The events a CARMEN log holds, in its order: of those of one stamp the wheel samples come first,
// since a laser line states their pose.
std::vector<const SensorEvent*> carmen_events(const SensorLog& log);

// Who is named on a line as the computer that logged it.
inline constexpr std::string_view kCarmenHost = "corridor-bench";

// CARMEN's tv and rv of a line: its robot's forward speed and turn rate.
struct CarmenSpeed {
  double forward_mps = 0;
  double turn_radps = 0;
};

// The speeds that the poses of a log's lines tell: each the mean since the line before with another
// stamp, the first the mean until the next. Steps that go back in time or faster than LogLimits
// tell no speed: the last one holds. A pose interpolated between two changes none of them.
std::vector<CarmenSpeed> carmen_speeds(const std::vector<WheelSample>& lines);

// Scans as ROBOTLASER1, wheel samples as ODOM. A scan without a wheel sample of its stamp states
// the pose interpolated between its neighbours. Speeds follow from the poses. The log must have a
// wheel sample.
std::string carmen_text(const SensorLog& log);

}  // namespace corridor::formats
