// One clock for a log whose calibration says that the LiDAR's is another than the wheels'
// (lidar.time_offset_s): the one place where that number is applied, for every format whose reader
// does not (LCM and tick logs, whose models say 0 once read).
// It estimates no offset.
#pragma once

#include <vector>

#include "datasets/formats/trajectories/relations.hpp"
#include "slam/core/sensor_log.hpp"

namespace corridor::formats {

// With d = lidar.time_offset_s (LiDAR clock minus wheel clock): scans move by -d, events are put
// back into the order of their stamps (a scan after the other sensors' readings of its stamp, as
// logs have it), the model's offset becomes 0 and provenance says so.
// Truth and relations move along where they carry the scans' stamps: where at least half of their
// stamps are those of scans to 1 us (text and rawlogs round differently). Others have a clock of
// their own, taken for the wheels', which provenance says too. `relations` may be null.
// Returns d: 0 if there was nothing to do. Stamps of each sensor must increase (read_log sees to
// it).
double move_onto_wheel_clock(SensorLog& log, std::vector<Relation>* relations);

}  // namespace corridor::formats
