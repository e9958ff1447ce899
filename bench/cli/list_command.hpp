// corridor-bench list WHAT [--json]: what this program knows by name.
#pragma once

#include <string>

#include "bench/cli/command.hpp"

namespace corridor::cli {

struct ListCommand {
  CommonOptions common;
  std::string what;
  bool is_json = false;

  void add_to(CLI::App& command);
  [[nodiscard]] Result<ExitCode> run() const;
};

}  // namespace corridor::cli
