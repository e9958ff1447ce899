#include "bench/cli/run_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Option.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <set>
#include <utility>

#include "bench/cli/option_checks.hpp"
#include "bench/runner/back_ends.hpp"
#include "bench/runner/data_kind.hpp"
#include "bench/runner/exit_code.hpp"
#include "bench/runner/folder_lock.hpp"
#include "bench/runner/plan.hpp"
#include "bench/runner/run_plan.hpp"

namespace corridor::cli {
namespace {

namespace fs = std::filesystem;

// Of runs without a suite.
constexpr const char* kOwnRunName = "own";

Result<fs::path> this_program() {
  std::error_code error;
  const fs::path path = fs::read_symlink("/proc/self/exe", error);
  if (!error) return path;
  return fail(ErrorCode::kInternal, "this program's own path is unknown", "/proc/self/exe");
}

Result<void> replace_data(const std::vector<std::string>& datasets, const catalog::DataDirs& dirs,
                          runner::Suite& suite) {
  const Result<catalog::Catalog> known = catalog::known_datasets(dirs);
  if (!known) return tl::make_unexpected(known.error());
  suite.scenarios.clear();
  suite.datasets.clear();
  for (const std::string& dataset : datasets) {
    const Result<runner::DataKind> kind = runner::kind_of_data(dataset, *known);
    if (!kind) return tl::make_unexpected(kind.error());
    const bool is_simulated = *kind == runner::DataKind::kSimulated;
    (is_simulated ? suite.scenarios : suite.datasets).push_back(dataset);
  }
  return {};
}

std::vector<std::string> without_repeats(const std::vector<std::string>& names) {
  std::vector<std::string> once;
  for (const std::string& name : names) {
    if (std::find(once.begin(), once.end(), name) == once.end()) once.push_back(name);
  }
  return once;
}

tl::unexpected<Error> at_option(std::string option, const Error& error) {
  return fail(error.code, error.what, std::move(option), error.expected);
}

// Every --set says something that no other one says, about a system or back-end that is run.
Result<void> check_overrides(const runner::Suite& suite, const std::vector<std::string>& texts) {
  std::set<std::string> keys;
  for (const std::string& text : texts) {
    const std::string key = text.substr(0, text.find('='));
    if (!keys.insert(key).second) {
      return fail(ErrorCode::kInvalid, fmt::format("{} is given twice", key), "--set",
                  "each parameter once");
    }
    const std::string owner = key.substr(0, key.find('.'));
    if (runner::check_back_end(owner)) {
      const std::vector<std::string> used = runner::back_ends_of(suite);
      if (std::find(used.begin(), used.end(), owner) != used.end()) continue;
      return fail(ErrorCode::kInvalid, fmt::format(R"(back-end "{}" is not run)", owner), "--set",
                  used.empty() ? "a system" : fmt::format("one of: {}", fmt::join(used, ", ")));
    }
    const auto runs_it = [&](const runner::SystemChoice& choice) { return choice.system == owner; };
    if (std::any_of(suite.systems.begin(), suite.systems.end(), runs_it)) continue;
    std::vector<std::string> run;
    for (const runner::SystemChoice& choice : suite.systems) run.push_back(choice.system);
    return fail(ErrorCode::kInvalid, fmt::format(R"(system "{}" is not run)", owner), "--set",
                fmt::format("one of: {}", fmt::join(without_repeats(run), ", ")));
  }
  return {};
}

// Says how it went; the exit code.
ExitCode finish(const runner::RunSummary& summary, const std::string& what_was_done,
                const CommonOptions& common) {
  if (summary.is_interrupted) {
    std::fputs("corridor-bench: interrupted; --resume goes on where it stopped\n", stderr);
    return runner::kExitNo;
  }
  common.say(what_was_done);
  return summary.num_failed == 0 ? runner::kExitDone : runner::kExitNo;
}

}  // namespace

void RunCommand::add_to(CLI::App& command) {
  command.add_option("suite", suite, "Name of a suite, or a suite's .toml file")
      ->type_name("SUITE");
  command.add_option("--out", out, "Folder of the results (default: reports/out/SUITE, from here)")
      ->type_name("DIR");
  command.add_option("--jobs", num_jobs, "Cases at a time (default: 1, for undisturbed times)")
      ->check(whole_number_in(1, kMaxJobs));
  command.add_option("--seeds", num_seeds, "Number of seeds instead of the suite's")
      ->check(whole_number_in(1, 100'000));
  command
      .add_option("--seed", first_seed,
                  "First seed instead of the suite's; those below 1000 are for development")
      ->type_name("N");
  command.add_option("--system", systems, "System, S or S@PROFILE, instead of the suite's; repeat")
      ->type_name("S[@PROFILE]");
  command.add_option("--backend", backends, "Back-end instead of the systems' own; repeat");
  command.add_option(
      "--dataset", datasets,
      "Data set, file, scenario or graph-of:SYSTEM:DATA[:SEED] instead of the suite's; repeat");
  command.add_option("--set", overrides, "Parameter of a system or back-end; repeat")
      ->type_name("NAME.key=value");
  command.add_flag("--resume", is_resumed,
                   "Keep cases in DIR that are finished and were run by this build of the program");
  command.add_flag("--no-report", has_no_report, "Leave out tables, figures and page");
  command.add_option("--executor", executor, "local: processes on this machine");
  common.add_to(command);
}

Result<void> RunCommand::apply_seeds(runner::Suite& requested) const {
  if (num_seeds) requested.num_seeds = *num_seeds;
  if (first_seed) {
    const Result<std::uint64_t> seed = seed_from_text(*first_seed);
    if (!seed) return tl::make_unexpected(seed.error());
    requested.first_seed = *seed;
  }
  const auto num_more = static_cast<std::uint64_t>(requested.num_seeds - 1);
  const std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
  if (requested.first_seed <= last - num_more) return {};
  return fail(ErrorCode::kInvalid,
              fmt::format("{} seeds from {} on are more than there are", requested.num_seeds,
                          requested.first_seed),
              "--seed", fmt::format("a last seed of at most {}", last));
}

Result<runner::Suite> RunCommand::requested_suite() const {
  runner::Suite requested;
  requested.name = kOwnRunName;
  if (!suite.empty()) {
    const Result<fs::path> path = runner::find_suite(suite);
    if (!path) return tl::make_unexpected(path.error());
    Result<runner::Suite> read = runner::read_suite(*path);
    if (!read) return read;
    requested = std::move(*read);
  } else if (systems.empty() || datasets.empty()) {
    return fail(ErrorCode::kInvalid, "neither a suite nor both --system and --dataset are given",
                "run", "SUITE, or --system S --dataset FILE");
  }
  if (!systems.empty()) requested.systems.clear();
  for (const std::string& text : systems) {
    const Result<runner::SystemChoice> choice = runner::parse_system_choice(text);
    if (!choice) return at_option("--system", choice.error());
    auto& chosen = requested.systems;
    if (std::find(chosen.begin(), chosen.end(), *choice) == chosen.end()) chosen.push_back(*choice);
  }
  for (const std::string& name : backends) {
    const Result<void> known = runner::check_back_end(name);
    if (!known) return at_option("--backend", known.error());
  }
  if (!backends.empty()) {
    requested.backends = without_repeats(backends);
    requested.backends_of.clear();
  }
  if (!datasets.empty()) {
    const Result<void> replaced =
        replace_data(without_repeats(datasets), common.data_dirs(), requested);
    if (!replaced) return tl::make_unexpected(replaced.error());
  }
  if (const Result<void> good = apply_seeds(requested); !good) {
    return tl::make_unexpected(good.error());
  }
  const Result<void> added = runner::add_overrides(requested, overrides);
  if (!added) return tl::make_unexpected(added.error());
  if (const Result<void> clear = check_overrides(requested, overrides); !clear) {
    return tl::make_unexpected(clear.error());
  }
  return requested;
}

Result<ExitCode> RunCommand::run(const ReportWriter& write_report) const {
  if (executor != "local") {
    return fail(ErrorCode::kUnsupported, fmt::format(R"(executor "{}" is not known)", executor),
                "--executor", "local");
  }
  const Result<runner::Suite> requested = requested_suite();
  if (!requested) return tl::make_unexpected(requested.error());
  const Result<runner::Plan> plan =
      runner::make_plan(*requested, common.data_dirs(), {!datasets.empty()});
  if (!plan) return tl::make_unexpected(plan.error());
  if (plan->cases.empty()) {
    return fail(ErrorCode::kNotFound,
                fmt::format("no case can be run: {}", fmt::join(plan->skipped, "; ")),
                requested->name, "data that can be found (--data-dir) and that the systems take");
  }
  const Result<fs::path> program = this_program();
  if (!program) return tl::make_unexpected(program.error());

  // Held until the report is written.
  const Result<runner::FolderLock> folder = runner::FolderLock::take(
      fs::absolute(out.empty() ? fs::path("reports/out") / requested->name : fs::path(out)));
  if (!folder) return tl::make_unexpected(folder.error());
  const fs::path& results = folder->folder();
  runner::RunOptions options;
  options.executable = *program;
  options.data_dir = common.data_path();
  options.num_jobs = num_jobs;
  options.is_resumed = is_resumed;
  options.is_quiet = common.is_quiet;
  options.is_terminal = isatty(STDOUT_FILENO) != 0;
  const Result<runner::RunSummary> summary = runner::run_plan(*plan, *folder, options);
  if (!summary) return tl::make_unexpected(summary.error());
  if (!has_no_report && !summary->is_interrupted) {
    const Result<void> written = write_report({results}, results);
    if (!written) return tl::make_unexpected(written.error());
  }
  return finish(*summary,
                fmt::format("{} cases, {} kept from before, {} failed: {}", summary->num_cases,
                            summary->num_kept, summary->num_failed, results.string()),
                common);
}

}  // namespace corridor::cli
