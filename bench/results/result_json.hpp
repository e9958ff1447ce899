// A result record as JSON: the contract of result.json. Every key is always written, null where it
// does not apply; a number that is not finite has no JSON form and is written as null.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "bench/results/run_result.hpp"
#include "slam/core/result.hpp"

namespace corridor::results {

// Indented by two blanks, ends with a line feed.
std::string to_json(const RunResult& result);

// A key that is not there keeps its default (files of older revisions), keys not known are skipped
// (files of newer ones). Wrong types, an unknown status or broken syntax are errors that name
// `where`.
Result<RunResult> result_from_json(std::string_view text, std::string_view where);

Result<RunResult> read_result(const std::filesystem::path& path);

}  // namespace corridor::results
