// What the numbers say, in sentences: every one computed from the cases, none written in advance.
#pragma once

#include <string>
#include <vector>

#include "reports/cases.hpp"

namespace corridor::html {

// Per data set with true poses: which system is the most accurate, how the fusion systems compare
// with each rival, which way the map is wrong; then how many cases failed. Plain text, to be
// escaped.
std::vector<std::string> verdicts(const reports::Cases& cases);

}  // namespace corridor::html
