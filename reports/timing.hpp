// What has to be known before a time is believed: how many cases ran at a time, on which machines.
#pragma once

#include <string>
#include <vector>

#include "reports/cases.hpp"

namespace corridor::reports {

// Sentences that belong beside every table and figure of times: always one about cases at a time,
// more where machines or thread counts are mixed.
std::vector<std::string> timing_notes(const Cases& cases);

}  // namespace corridor::reports
