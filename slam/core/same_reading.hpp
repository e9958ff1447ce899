// Whether two readings of one sensor say the same, whatever their stamps.
#pragma once

#include <string_view>

#include "slam/core/sensor_log.hpp"

namespace corridor {

// Exactly: no tolerance. Geometry of a scan does not count, nor do ticks: a pose follows from them.
// Readings of different sensors are never the same.
bool is_same_reading(const SensorEvent& a, const SensorEvent& b);
bool is_same_reading(const LaserScan& a, const LaserScan& b);

// What `a` has other than `b`: "another pose", "other ranges", "other values"; empty for the same
// reading. Requires readings of one sensor.
std::string_view difference_of(const SensorEvent& a, const SensorEvent& b);

}  // namespace corridor
