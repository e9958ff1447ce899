// What `convert` and `simulate` share: a log is written under a name at which nothing of another
// log lies, is read again before it is there, and what it cannot hold is said.
// It does not decide what goes beside the log.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/cli/command.hpp"
#include "bench/cli/staged_files.hpp"
#include "datasets/formats/log_io.hpp"

namespace corridor::cli {

// By the suffix of OUT; the Error lists the suffixes there are.
Result<formats::LogFormat> format_to_write(const std::filesystem::path& out);

// Fails if a file lies beside OUT that would pass for one of the new log or calibrate it, and is
// none of `own`: those that are written with it, or are its own already.
Result<void> refuse_strangers(const std::filesystem::path& out, formats::LogFormat format,
                              const std::vector<std::filesystem::path>& own);

// Writes what lies beside the log.
using CompanionWriter = std::function<Result<void>(const StagedFiles& staged)>;

// OUT and its truth, and what `write_companions` adds; all or nothing. Fails if the suite's own
// reader refuses what was written, or if another log's file would be overwritten: one with other
// content where OUT is not there yet, or shares its name with another log.
Result<void> write_log_whole(const SensorLog& log, const std::filesystem::path& out,
                             const CompanionWriter& write_companions);

// "3 scans, 4 wheel samples, 5 inertial samples": what a file of this format holds of the log.
std::string text_of_held(const SensorLog& log, formats::LogFormat format);

// A line for everything that such a file cannot hold; whether there was any.
bool say_losses(const SensorLog& log, formats::LogFormat format, const CommonOptions& common);

}  // namespace corridor::cli
