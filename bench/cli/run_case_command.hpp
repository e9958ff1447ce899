// corridor-bench run-case SPEC.json --out DIR: one case in this process.
#pragma once

#include <optional>
#include <string>

#include "bench/cli/command.hpp"

namespace corridor::cli {

struct RunCaseCommand {
  CommonOptions common;
  std::string spec;
  std::string out;
  std::optional<int> num_jobs;

  void add_to(CLI::App& command);
  [[nodiscard]] Result<ExitCode> run() const;
};

}  // namespace corridor::cli
