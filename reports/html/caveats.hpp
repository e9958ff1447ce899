// What a reader has to know before believing the comparison: only what applies to these cases.
#pragma once

#include <string>
#include <vector>

#include "reports/cases.hpp"

namespace corridor::html {

// Plain text, to be escaped: how rivals are configured, who reads which sensor, what simulator and
// estimators share, what intervals do not cover, how many cases ran at a time, what
// the runner noted about the scores, which revisions.
std::vector<std::string> caveats(const reports::Cases& cases);

}  // namespace corridor::html
