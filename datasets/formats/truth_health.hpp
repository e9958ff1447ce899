// What `examine` counts of a log's truth: how many scans it covers, how fast and how far it goes
// beside the wheels. Internal to this folder.
#pragma once

#include "datasets/formats/log_health.hpp"

namespace corridor::formats {

// Requires a truth. Paths are compared between poses a second or more apart, of truth and wheels at
// the same times: so that neither noise of single poses nor poses beyond the wheels' log count.
TruthHealth truth_health_of(const SensorLog& log, const LogLimits& limits);

}  // namespace corridor::formats
