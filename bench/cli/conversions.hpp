// The three kinds of `convert`: each reads IN, writes OUT whole or not at all and says what OUT
// cannot hold. Which of them is meant is decided in convert_command.cpp.
#pragma once

#include <filesystem>
#include <string>

#include "bench/cli/command.hpp"

namespace corridor::cli {

// `in`: a log file or the name of a data set. Truth, relations and world go along. A data set whose
// files are others than the catalogue's is taken on request, and said.
Result<ExitCode> convert_log(const std::string& in, const std::filesystem::path& out,
                             bool accept_other_checksum, const CommonOptions& common);

// `in`: a graph file or the name of a data set.
Result<ExitCode> convert_graph(const std::string& in, const std::filesystem::path& out,
                               const CommonOptions& common);

Result<ExitCode> convert_trajectory(const std::filesystem::path& in,
                                    const std::filesystem::path& out, const CommonOptions& common);

}  // namespace corridor::cli
