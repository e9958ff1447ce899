// The program corridor-bench: takes the command line apart and starts the command.
// Errors go to stderr in one line; the exit codes are those of bench/runner/exit_code.hpp.

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>
#include <functional>
#include <iostream>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "bench/cli/convert_command.hpp"
#include "bench/cli/data_command.hpp"
#include "bench/cli/evaluate_command.hpp"
#include "bench/cli/fetch_command.hpp"
#include "bench/cli/inspect_command.hpp"
#include "bench/cli/list_command.hpp"
#include "bench/cli/report_command.hpp"
#include "bench/cli/run_case_command.hpp"
#include "bench/cli/run_command.hpp"
#include "bench/cli/simulate_command.hpp"
#include "bench/cli/solve_command.hpp"
#include "bench/runner/exit_code.hpp"
#include "bench/runner/git_revision.hpp"
#include "reports/figures/tree_figure.hpp"
#include "reports/report.hpp"

namespace {

using corridor::Result;
using corridor::cli::ExitCode;
using corridor::cli::print_error;

struct Commands {
  corridor::cli::ListCommand list;
  corridor::cli::RunCommand run;
  corridor::cli::RunCaseCommand run_case;
  corridor::cli::SimulateCommand simulate;
  corridor::cli::ConvertCommand convert;
  corridor::cli::EvaluateCommand evaluate;
  corridor::cli::SolveCommand solve;
  corridor::cli::ReportCommand report;
  corridor::cli::DataListCommand data_list;
  corridor::cli::DataVerifyCommand data_verify;
  corridor::cli::FetchCommand data_fetch;
  corridor::cli::InspectCommand data_inspect;
};

using Action = std::function<Result<ExitCode>()>;

// Declares every command; returns what each of them does.
std::vector<std::pair<const CLI::App*, Action>> declare(CLI::App& app, Commands& c) {
  std::vector<std::pair<const CLI::App*, Action>> actions;
  const auto add = [&](CLI::App& parent, const char* name, const char* help, auto& command,
                       Action action) {
    CLI::App* sub = parent.add_subcommand(name, help);
    command.add_to(*sub);
    actions.emplace_back(sub, std::move(action));
  };
  add(app, "list", "What this program knows by name", c.list, [&c] { return c.list.run(); });
  add(app, "run", "Run a suite, or systems on your own logs, and write the report", c.run,
      [&c] { return c.run.run(corridor::reports::write_report); });
  add(app, "run-case", "Run one case in this process", c.run_case,
      [&c] { return c.run_case.run(); });
  add(app, "simulate", "Write a simulated log and its truth", c.simulate,
      [&c] { return c.simulate.run(); });
  add(app, "convert", "Convert a log to another format, saying what is lost", c.convert,
      [&c] { return c.convert.run(); });
  add(app, "evaluate", "Score a trajectory and a map from files", c.evaluate,
      [&c] { return c.evaluate.run(); });
  add(app, "solve", "Solve a pose graph with a back-end and measure it", c.solve,
      [&c] { return c.solve.run(corridor::figures::tree_svg); });
  add(app, "report", "Write tables, figures and page from finished runs", c.report,
      [&c] { return c.report.run(corridor::reports::write_report); });
  CLI::App* data = app.add_subcommand("data", "Data sets on this machine");
  data->require_subcommand(1);
  add(*data, "list", "Known data sets, and which are here", c.data_list,
      [&c] { return c.data_list.run(); });
  add(*data, "verify", "Compare data sets with the catalogue's checksums", c.data_verify,
      [&c] { return c.data_verify.run(); });
  add(*data, "fetch", "Download data sets and compare their checksums", c.data_fetch,
      [&c] { return c.data_fetch.run(); });
  add(*data, "inspect", "What a log holds and what is wrong with it", c.data_inspect,
      [&c] { return c.data_inspect.run(); });
  return actions;
}

// "list, run or report".
std::string alternatives(const CLI::App& parent) {
  const auto commands = parent.get_subcommands([](const CLI::App*) { return true; });
  std::string text;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (i > 0) text += i + 1 == commands.size() ? " or " : ", ";
    text += commands[i]->get_name();
  }
  return text;
}

// The words of the request as far as they are commands, and the first that is none; nothing if
// every word that should be a command is one.
std::string unknown_command(const CLI::App& app, int argc, char** argv, const CLI::App*& parent) {
  parent = &app;
  std::string words;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.empty() || word.front() == '-') return "";
    words += (words.empty() ? "" : " ") + word;
    const auto named = parent->get_subcommands(
        [&word](const CLI::App* command) { return command->get_name() == word; });
    if (named.empty()) return words;
    parent = named.front();
    if (parent->get_require_subcommand_min() == 0) return "";
  }
  return "";
}

// Help and version are answers on stdout, everything else is a wrong request.
int answer_parse_error(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  if (error.get_exit_code() == 0) return app.exit(error);
  const CLI::App* parent = nullptr;
  const std::string unknown = unknown_command(app, argc, argv, parent);
  if (unknown.empty()) {
    print_error(std::string(error.what()) + "; see --help");
  } else {
    print_error(
        fmt::format(R"(unknown command "{}"; expected {})", unknown, alternatives(*parent)));
  }
  return corridor::runner::kExitBadRequest;
}

int run(int argc, char** argv) {
  CLI::App app("Corridor Bench: compares SLAM systems and back-ends on identical data",
               "corridor-bench");
  app.set_version_flag("--version", "corridor-bench " + corridor::runner::git_revision());
  app.require_subcommand(1);
  Commands commands;
  const auto actions = declare(app, commands);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return answer_parse_error(app, error, argc, argv);
  }
  for (const auto& [command, action] : actions) {
    if (!command->parsed()) continue;
    const Result<ExitCode> code = action();
    if (code) return *code;
    print_error(code.error().to_line());
    return corridor::runner::kExitBadRequest;
  }
  return corridor::runner::kExitBadRequest;
}

// What was said must have arrived: a full disk behind stdout is an error.
int check_output(int exit_code) {
  const bool is_flushed = std::fflush(stdout) == 0 && std::cout.flush().good();
  if (is_flushed && std::ferror(stdout) == 0) return exit_code;
  print_error("stdout: the output cannot be written; expected a file or pipe with room");
  return exit_code == 0 ? corridor::runner::kExitBadRequest : exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return check_output(run(argc, argv));
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
    return corridor::runner::kExitOutOfMemory;
  }
}
