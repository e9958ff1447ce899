// One parser and one writer per trajectory format, on text. Internal to this folder;
// trajectory_io.hpp is the door.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "datasets/formats/trajectories/trajectory_io.hpp"

namespace corridor::formats {

// `name` stands for the file in messages. Lines that start with '#' and empty lines are skipped.

Result<ReadTrajectory> parse_tum_trajectory(std::string_view text, const std::string& name);

// `times` has one stamp in seconds a line, as many as `poses` has matrices.
Result<ReadTrajectory> parse_kitti(std::string_view poses, const std::string& name,
                                   std::string_view times, const std::string& times_name);
std::string kitti_text(const Trajectory& trajectory);
std::string times_text(const Trajectory& trajectory);

Result<ReadTrajectory> parse_euroc(std::string_view text, const std::string& name);
std::string euroc_text(const Trajectory& trajectory);

// Poses of FLASER lines (or else of ROBOTLASER1 lines): the first, which SLAM programs correct; in
// a raw log it is the odometry again. Written as FLASER lines without beams.
Result<ReadTrajectory> parse_carmen_trajectory(std::string_view text, const std::string& name);
std::string carmen_trajectory_text(const Trajectory& trajectory);

}  // namespace corridor::formats
