// corridor-bench convert IN OUT: between log formats, between trajectory formats, between graph
// formats, saying what the target cannot hold.
#pragma once

#include <string>

#include "bench/cli/command.hpp"

namespace corridor::cli {

struct ConvertCommand {
  CommonOptions common;
  std::string in;
  std::string out;
  bool accept_other_checksum = false;

  void add_to(CLI::App& command);
  [[nodiscard]] Result<ExitCode> run() const;
};

}  // namespace corridor::cli
