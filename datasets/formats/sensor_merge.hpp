// Events of several sensors put into one order by their stamps, where a log keeps the order in
// which they arrived. Internal to this folder.
#pragma once

#include <cstddef>

#include "datasets/formats/parsed_log.hpp"

namespace corridor::formats {

// Merges the sensors' readings; those of one sensor keep their order, so that a stamp of one sensor
// that steps back stays one. At equal stamps the reading that stood first in the file comes first.
// Returns the number of readings that come after one that stood behind them in the file.
std::size_t merge_sensors(ParsedLog& log);

}  // namespace corridor::formats
