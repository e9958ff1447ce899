// Text logs of one line of 707 tokens per scan: raw wheel ticks and a 240 degree LiDAR. Internal to
// this folder; log_io.hpp is the door.
//   token 0       stamp in microseconds
//   tokens 2, 3   cumulative ticks of the left and the right wheel
//   tokens 24-705 682 ranges in millimetres, counter-clockwise from the right, 1024 steps a turn,
//                 the middle ahead; 0 = no return, 1-19 are the sensor's error codes
// The other tokens have no use here. Beams 70 to 612 are used: the robot covers the others.
#pragma once

#include <string>
#include <string_view>

#include "datasets/formats/parsed_log.hpp"
#include "datasets/formats/raw_sensors.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

// Ticks become odometry by the robot's wheels (tick_odometry.hpp). A row's scan was taken
// lidar.time_offset_s before the row's stamp: the scans are moved by it and put in order with the
// ticks. With RawClock::kScanRate they are put onto a constant rate before; a row that is more than
// three periods off it is an Error. Ranges beyond lidar.range_max_m are no return.
Result<ParsedLog> parse_ticks(std::string_view text, const std::string& file,
                              const RobotModel& robot, RawClock clock);

}  // namespace corridor::formats
