// How many readings a rawlog of the suite's own holds, as its leading comment says: MRPT's format
// has no end, so that a file cut between two objects looks whole. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "slam/core/result.hpp"

namespace corridor::formats {

// A comment of TOML, the first line before the robot model; readers that do not know it skip it.
std::string stated_readings_line(std::size_t num_readings);

// nullopt for comments that state none: those of other programs, and of the suite before it did.
// `where` is for the Error that a number which is none gives.
Result<std::optional<std::uint64_t>> stated_readings(std::string_view comment,
                                                     const std::string& where);

}  // namespace corridor::formats
