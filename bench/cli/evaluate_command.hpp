// corridor-bench evaluate: scores of a trajectory, and of a map, that any program left in files.
#pragma once

#include <string>

#include "bench/cli/command.hpp"

namespace corridor::cli {

struct EvaluateCommand {
  CommonOptions common;
  std::string estimate;
  std::string truth;
  std::string relations;
  std::string map;
  std::string world;
  std::string alignment = "origin";
  std::string association = "nearest";
  double max_dt_s = 0.01;
  bool is_json = false;

  void add_to(CLI::App& command);
  [[nodiscard]] Result<ExitCode> run() const;
};

}  // namespace corridor::cli
