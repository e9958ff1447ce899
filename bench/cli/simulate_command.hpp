// corridor-bench simulate SCENARIO --out LOG: a log with its truth beside it.
#pragma once

#include <string>

#include "bench/cli/command.hpp"

namespace corridor::cli {

struct SimulateCommand {
  CommonOptions common;
  std::string scenario;
  std::string seed = "1";
  std::string out;

  void add_to(CLI::App& command);
  [[nodiscard]] Result<ExitCode> run() const;
};

}  // namespace corridor::cli
