// Trajectories in and out: one door for every trajectory format of the suite. All are planar here,
// T_map_base in metres and radians; height is left out and counted.
//   TUM     .tum               stamp x y z qx qy qz qw             [Sturm2012]; stamps in seconds
//   KITTI   .kitti             the 12 numbers of a 3x4 matrix [R t], row by row; stamps in X.times
//   EuRoC   .csv               ns,tx,ty,tz,qw,qx,qy,qz (or the 17 columns of its ground truth)
//   CARMEN  .clf .clf.gz       corrected poses of FLASER or ROBOTLASER1 lines, as evaluators of
//                              [Kuemmerle2009] read them
// KITTI's own files are in camera axes (y down); ours are in the robot's (z up).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "slam/core/result.hpp"
#include "slam/core/trajectory.hpp"

namespace corridor::formats {

enum class TrajectoryFormat { kTum, kKitti, kEuroc, kCarmen };

// "TUM", "KITTI", "EuRoC", "CARMEN".
std::string_view to_text(TrajectoryFormat format);

std::optional<TrajectoryFormat> trajectory_format_from_suffix(const std::filesystem::path& path);

// The file of stamps beside a KITTI trajectory: "a/b.kitti" -> "a/b.times".
std::filesystem::path times_beside(const std::filesystem::path& kitti);

struct ReadTrajectory {
  Trajectory trajectory;
  std::vector<std::string> notes;  // counted things left out
};

// The first line that breaks a rule is an Error with file:line: field count, number syntax, values
// that are not finite, stamps that do not increase, rotations that are none (a zero quaternion) or
// lead out of the plane. Stamps whose steps cannot be the format's unit are an Error too.
Result<ReadTrajectory> read_trajectory(const std::filesystem::path& path);

// By the suffix; a KITTI trajectory's stamps go to X.times. Covariances are not written.
Result<void> write_trajectory(const Trajectory& trajectory, const std::filesystem::path& path);

// What `target` cannot hold of this very trajectory, one line each; empty = nothing is lost.
std::vector<std::string> losses_of_conversion(const Trajectory& trajectory,
                                              TrajectoryFormat target);

}  // namespace corridor::formats
