#include "bench/cli/report_command.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Option.hpp>

#include "bench/runner/exit_code.hpp"

namespace corridor::cli {

void ReportCommand::add_to(CLI::App& command) {
  command.add_option("run_dirs", run_dirs, "Folders that `run` left")
      ->required()
      ->type_name("RUN_DIR");
  command.add_option("--out", out, "Folder of the report")->required()->type_name("DIR");
  common.add_to(command);
}

Result<ExitCode> ReportCommand::run(const ReportWriter& write_report) const {
  const std::vector<std::filesystem::path> paths(run_dirs.begin(), run_dirs.end());
  const Result<void> written = write_report(paths, out);
  if (!written) return tl::make_unexpected(written.error());
  common.say((std::filesystem::path(out) / "index.html").string());
  return runner::kExitDone;
}

}  // namespace corridor::cli
