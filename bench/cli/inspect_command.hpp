// corridor-bench data inspect LOG|NAME: what a log holds and what is wrong with it, also of logs
// that no other command takes.
#pragma once

#include <string>

#include "bench/cli/command.hpp"

namespace corridor::cli {

struct InspectCommand {
  CommonOptions common;
  std::string log;
  bool is_json = false;

  void add_to(CLI::App& command);
  // 1 if the log has a defect for which it is refused elsewhere; 2 if it is no log of its format.
  [[nodiscard]] Result<ExitCode> run() const;
};

}  // namespace corridor::cli
