// corridor-bench run: a suite, or one's own systems on one's own logs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/cli/command.hpp"
#include "bench/runner/suite.hpp"

namespace corridor::cli {

struct RunCommand {
  CommonOptions common;
  std::string suite;
  std::string out;
  int num_jobs = 1;
  std::optional<int> num_seeds;
  std::optional<std::string> first_seed;
  std::vector<std::string> systems;
  std::vector<std::string> backends;
  std::vector<std::string> datasets;
  std::vector<std::string> overrides;
  std::string executor = "local";
  bool is_resumed = false;
  bool has_no_report = false;

  void add_to(CLI::App& command);
  [[nodiscard]] Result<ExitCode> run(const ReportWriter& write_report) const;

 private:
  [[nodiscard]] Result<void> apply_seeds(runner::Suite& requested) const;
  [[nodiscard]] Result<runner::Suite> requested_suite() const;
};

}  // namespace corridor::cli
