// Scans that stay the same while the wheels move on: a LiDAR, or its driver, that hangs. Internal
// to this folder.
#pragma once

#include <cstddef>

#include "slam/core/sensor_log.hpp"

namespace corridor::formats {

struct FrozenScans {
  std::size_t num_scans = 0;         // of the run of scans, each exactly the one before
  std::size_t last_event_index = 0;  // of the run
  double moved_m = 0;                // by the wheels, away from where they were at the run's first
  double turned_rad = 0;             // likewise, at most half a turn
};

// The run over which the wheels get farthest; of runs without a move, one by turn. Scans without
// any return are left out: they say nothing. A robot that stands has no such run: what counts is
// how far the wheels are from where they were, not the noise of their readings.
FrozenScans longest_frozen_scans(const SensorLog& log);

}  // namespace corridor::formats
