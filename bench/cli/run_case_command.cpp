#include "bench/cli/run_case_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "bench/cli/option_checks.hpp"
#include "bench/runner/case_files.hpp"
#include "bench/runner/case_spec.hpp"
#include "bench/runner/exit_code.hpp"
#include "bench/runner/run_case.hpp"

namespace corridor::cli {

void RunCaseCommand::add_to(CLI::App& command) {
  command.add_option("spec", spec, "The case, as `run` writes it (runs/CASE/spec.json)")
      ->required()
      ->type_name("SPEC.json");
  command.add_option("--out", out, "Folder of the results: the case goes to DIR/runs/CASE-ID")
      ->required()
      ->type_name("DIR");
  command
      .add_option("--jobs", num_jobs, "Cases that run at a time on this machine, for the record")
      ->check(whole_number_in(1, kMaxJobs));
  common.add_to(command);
}

Result<ExitCode> RunCaseCommand::run() const {
  const Result<runner::CaseSpec> read = runner::read_case_spec(spec);
  if (!read) return tl::make_unexpected(read.error());
  const auto result = runner::run_case(*read, common.data_dirs(), out, num_jobs);
  if (!result && result.error().is_of_output) {
    print_error(result.error().error.to_line());
    return runner::kExitNotWritten;
  }
  if (!result) return tl::make_unexpected(result.error().error);
  common.say(fmt::format("{}: {}", runner::case_folder(out, result->case_id).string(),
                         to_text(result->status)));
  return result->status == results::CaseStatus::kFailed ? runner::kExitNo : runner::kExitDone;
}

}  // namespace corridor::cli
