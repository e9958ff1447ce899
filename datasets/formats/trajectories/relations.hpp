// Relative poses between two times of a log, set up by hand from the laser [Kuemmerle2009].
// One a line: "t1 t2 dx dy dz droll dpitch dyaw", pose at t2 in the frame of the pose at t1.
// It does not know whether the log has those times.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "slam/core/pose2.hpp"
#include "slam/core/result.hpp"
#include "slam/core/timestamp.hpp"

namespace corridor::formats {

// Published files hold some with t2 before t1, and some twice; they are kept as they are.
struct Relation {
  Timestamp t1;
  Timestamp t2;
  Pose2 T_1_2;

  bool operator==(const Relation&) const = default;
};

// An Error with file:line for a wrong field count, number syntax, a non-finite value, dz, droll or
// dpitch other than zero, t1 = t2, a turn of more than 2 pi (degrees), a motion faster than
// LogLimits allow (another unit), two relations between the same times that differ, a last line
// without its end (its last number may be cut), and for a file without any relation.
Result<std::vector<Relation>> read_relations(const std::filesystem::path& path);

// Those that stand before already.
std::size_t num_repeated(const std::vector<Relation>& relations);

Result<void> write_relations(const std::vector<Relation>& relations,
                             const std::filesystem::path& path);

}  // namespace corridor::formats
