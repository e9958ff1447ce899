// How to make the same numbers again: the commands, from the records alone.
#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "reports/cases.hpp"

namespace corridor::html {

// A shell script: for each revision its check-out and build, then runs whose cases are those of the
// records and no others: systems, back-ends and data sets share a command only where each ran with
// each, and every gap in the seeds starts another. What was set by hand stands there as --set; data
// are named by what was loaded. At the end the report. Names are quoted for a POSIX shell.
std::string reproduce_commands(const reports::Cases& cases);

// "1 to 5, 9".
std::string seed_ranges(const std::set<std::uint64_t>& seeds);

// "worlds 1001 to 1020; systems 1, 2".
std::string seed_text(const reports::Cases& cases);

}  // namespace corridor::html
