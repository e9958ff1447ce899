// MRPT rawlogs as events and back: the door to MRPT's serialization. Internal to this folder.
// Stamps count 100 ns since 1601 in the file and nanoseconds since 1970 here.
#pragma once

#include <string>
#include <string_view>

#include "datasets/formats/parsed_log.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

inline constexpr std::int64_t kRawlogTick_ns = 100;

// `bytes` is the decompressed file. Both kinds: observations in time order (the suite's own logs,
// whose leading comment is the robot model), and pairs of actions and sensory frames. An action's
// odometry increment leads from one sensory frame to the next [MRPT], so the accumulated pose is
// stamped with the first scan of the frame that follows; the action's own stamp (a midpoint in some
// logs) is used only if no frame follows. Of several LiDARs, told apart by
// their labels, the first is kept; what is left out is counted.
Result<ParsedLog> parse_rawlog(std::string_view bytes, const std::string& file);

// The decompressed file. MRPT's fan is symmetric about the sensor, so a scan whose angles are not
// is given with its sensor turned to the middle of the fan. An Error if MRPT fails or a stamp or
// tick count does not fit.
Result<std::string> rawlog_bytes(const SensorLog& log);

// The pose of a LiDAR whose fan is made symmetric: T_base_lidar turned to the middle beam.
Pose2 centred_lidar_pose(const LaserScan& scan);

}  // namespace corridor::formats
