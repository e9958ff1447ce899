// How to make the same numbers again: the commands, from the records alone.
#pragma once

#include <string>

#include "reports/cases.hpp"

namespace corridor::html {

// A shell script: for each revision its check-out and build, for each suite of it one run with its
// seeds, systems, data sets and, where a system ran on several, back-ends; at the end the report.
// Names are quoted for a POSIX shell. Which parameters were set by hand no record says: a comment.
std::string reproduce_commands(const reports::Cases& cases);

// "worlds 1001 to 1020; systems 1, 2".
std::string seed_text(const reports::Cases& cases);

}  // namespace corridor::html
