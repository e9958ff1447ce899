// An occupancy grid as a grey PNG image for people: white free, black occupied, grey unknown.
// It keeps no scale or origin: ros_map.hpp does.
#pragma once

#include <filesystem>

#include "slam/core/grid_map.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

// One pixel a cell, probability of being free as brightness, +y up. An Error for an empty map.
Result<void> write_map_png(const GridMap& map, const std::filesystem::path& path);

}  // namespace corridor::formats
