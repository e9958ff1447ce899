// What looks wrong in a log that may still be fit: units, axes and clocks that a reader takes at
// their word. Each rule has a wide margin, so that a sound log gives no line. Internal to this
// folder.
#pragma once

#include <string>
#include <vector>

#include "datasets/formats/log_health.hpp"

namespace corridor::formats {

// One line per suspicion: what, where, what it may be.
std::vector<std::string> suspicions_of(const LogHealth& health, const RobotModel& robot,
                                       const LogLimits& limits);

}  // namespace corridor::formats
