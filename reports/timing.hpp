// What has to be known before a time is believed: how many cases ran at a time, on which machines.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reports/cases.hpp"

namespace corridor::reports {

// How many cases the run had under way at a time; nullopt where the record does not say.
std::optional<std::int64_t> jobs_of(const results::RunResult& result);

// Sentences that belong beside every table and figure of times: always one about cases at a time,
// more where machines or thread counts are mixed.
std::vector<std::string> timing_notes(const Cases& cases);

}  // namespace corridor::reports
