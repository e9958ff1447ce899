// corridor-bench data list | verify [NAME]: which data sets are here, and whether they are the
// right ones.
#pragma once

#include <string>
#include <vector>

#include "bench/cli/command.hpp"

namespace corridor::cli {

struct DataListCommand {
  CommonOptions common;
  bool is_json = false;

  void add_to(CLI::App& command);
  [[nodiscard]] Result<ExitCode> run() const;
};

struct DataVerifyCommand {
  CommonOptions common;
  std::vector<std::string> names;  // empty: every data set

  void add_to(CLI::App& command);
  // 1 if a file differs, or if a data set that was named is not complete.
  [[nodiscard]] Result<ExitCode> run() const;
};

}  // namespace corridor::cli
