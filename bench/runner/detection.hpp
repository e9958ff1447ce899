// How well a system noticed slipping wheels and a LiDAR without information, against what the
// simulator knows. Only scans at which the system gave the flag are counted.
#pragma once

#include <span>

#include "bench/results/run_result.hpp"
#include "bench/runner/drive.hpp"
#include "datasets/simulation/truth.hpp"

namespace corridor::runner {

// A scan's flag speaks of the time since the scan before. A flag is true if a slip (or a degenerate
// interval) overlaps that time. Which direction is free is not asked: a flag names none, and a scan
// that sees nothing is as degenerate as one along a corridor.
//   precision = true alarms / alarms            null without alarms
//   recall    = scans noticed / scans affected  null where nothing was to be noticed
//   latency   = mean time from a slip's begin to its first alarm, over slips noticed before their
//   end
// Fills slip_* and degeneracy_* of `result`; where the truth does not say, they stay null.
void score_detection(std::span<const HealthSample> health, const simulation::SimulationTruth& truth,
                     results::RunResult& result);

}  // namespace corridor::runner
