// corridor-bench report RUN_DIR... --out DIR: tables, figures and page from finished runs.
#pragma once

#include <string>
#include <vector>

#include "bench/cli/command.hpp"

namespace corridor::cli {

struct ReportCommand {
  CommonOptions common;
  std::vector<std::string> run_dirs;
  std::string out;

  void add_to(CLI::App& command);
  [[nodiscard]] Result<ExitCode> run(const ReportWriter& write_report) const;
};

}  // namespace corridor::cli
