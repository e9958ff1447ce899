// Trajectories as TUM text: "stamp x y z qx qy qz qw", one pose a line [Sturm2012].
// Stamps have 9 decimals (exact to the nanosecond), the rest as many digits as give back the same
// double. Planar only: roll and pitch other than zero are refused, z is left out (trajectory_io.hpp
// counts it).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "slam/core/result.hpp"
#include "slam/core/trajectory.hpp"

namespace corridor::formats {

// Lines that start with '#' and empty lines are skipped. The first line that breaks a rule is an
// Error with file:line: field count, number syntax, non-finite value, stamp not later than the one
// before, quaternion not of unit length (within 1e-3), roll or pitch beyond 1e-6 rad. An Error with
// the file for stamps that cannot be seconds (trajectory_rules.hpp).
Result<Trajectory> read_tum(const std::filesystem::path& path);

// The same on text; `name` stands for the file in messages.
Result<Trajectory> parse_tum(std::string_view text, const std::string& name);
std::string tum_text(const Trajectory& trajectory);

// Covariances are not written.
Result<void> write_tum(const Trajectory& trajectory, const std::filesystem::path& path);

}  // namespace corridor::formats
