// Occupancy grids as ROS map_server reads them: STEM.pgm (8-bit) and STEM.yaml.
// Three values only: occupied 0, free 254, unknown 205. Hit counts and exact probabilities are
// lost.
#pragma once

#include <filesystem>

#include "slam/core/grid_map.hpp"
#include "slam/core/result.hpp"

namespace corridor::formats {

// Thresholds of map_server's defaults, on the probability of being occupied; in between is unknown.
inline constexpr double kOccupiedThreshold = 0.65;
inline constexpr double kFreeThreshold = 0.196;

enum class CellClass { kUnknown, kFree, kOccupied };
CellClass classify(const GridCell& cell);

// Writes STEM.pgm and STEM.yaml. Image rows run from the top (largest y) to the bottom; `origin` is
// the lower left corner of the lower left pixel. An Error for an empty map.
Result<void> write_ros_map(const GridMap& map, const std::filesystem::path& stem);

// Trinary mode. Hits are not in the file: an occupied cell gets one hit. A rotated origin is
// refused.
Result<GridMap> read_ros_map(const std::filesystem::path& yaml_path);

}  // namespace corridor::formats
