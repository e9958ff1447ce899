#include "bench/cli/report_command.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Option.hpp>
#include <system_error>

#include "bench/runner/exit_code.hpp"
#include "bench/runner/folder_lock.hpp"

namespace corridor::cli {
namespace {

namespace fs = std::filesystem;

// The folders of a path that are not there yet, innermost first.
std::vector<fs::path> missing_folders(const fs::path& path) {
  std::vector<fs::path> missing;
  std::error_code ignored;
  for (fs::path folder = path; folder.has_relative_path() && !fs::exists(folder, ignored);
       folder = folder.parent_path()) {
    missing.push_back(folder);
  }
  return missing;
}

Result<void> write_locked(const ReportWriter& write_report, const std::vector<fs::path>& run_dirs,
                          const fs::path& out) {
  const Result<runner::FolderLock> folder = runner::FolderLock::take(out);
  if (!folder) return tl::make_unexpected(folder.error());
  return write_report(run_dirs, out);
}

}  // namespace

void ReportCommand::add_to(CLI::App& command) {
  command.add_option("run_dirs", run_dirs, "Folders that `run` left")
      ->required()
      ->type_name("RUN_DIR");
  command.add_option("--out", out, "Folder of the report")->required()->type_name("DIR");
  common.add_to(command);
}

Result<ExitCode> ReportCommand::run(const ReportWriter& write_report) const {
  const std::vector<fs::path> paths(run_dirs.begin(), run_dirs.end());
  const std::vector<fs::path> created = missing_folders(fs::absolute(out).lexically_normal());
  const Result<void> written = write_locked(write_report, paths, out);
  if (!written) {
    // Only what is empty goes.
    std::error_code ignored;
    for (const fs::path& folder : created) fs::remove(folder, ignored);
    return tl::make_unexpected(written.error());
  }
  common.say((fs::path(out) / "index.html").string());
  return runner::kExitDone;
}

}  // namespace corridor::cli
