#include "bench/cli/simulate_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Option.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bench/cli/log_output.hpp"
#include "bench/cli/staged_files.hpp"
#include "bench/runner/exit_code.hpp"
#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/log_io.hpp"
#include "datasets/simulation/scenario.hpp"
#include "datasets/simulation/simulate.hpp"

namespace corridor::cli {
namespace {

namespace fs = std::filesystem;

// LOG, LOG.tum and LOG.truth.toml.
std::vector<fs::path> files_of(const fs::path& log) {
  return {log, formats::sidecar_of(log, ".tum"), formats::sidecar_of(log, ".truth.toml")};
}

Result<formats::LogFormat> check_out(const fs::path& out) {
  Result<formats::LogFormat> format = format_to_write(out);
  if (!format) return format;
  const std::vector<fs::path> files = files_of(out);
  if (const Result<void> good = check_targets(files); !good) {
    return tl::make_unexpected(good.error());
  }
  if (const Result<void> good = refuse_strangers(out, *format, files); !good) {
    return tl::make_unexpected(good.error());
  }
  return format;
}

Result<void> write_all(const simulation::Simulated& simulated, const fs::path& log) {
  return write_log_whole(simulated.log, log, [&](const StagedFiles& staged) {
    const std::string text = simulation::truth_toml(simulated);
    return formats::write_file_atomically(staged.path_for(formats::sidecar_of(log, ".truth.toml")),
                                          std::string_view(text));
  });
}

}  // namespace

void SimulateCommand::add_to(CLI::App& command) {
  command.add_option("scenario", scenario, "Name of a scenario, or its .toml file")
      ->required()
      ->type_name("SCENARIO");
  command.add_option("--seed", seed, "What is drawn: start, speed, errors, noise (default: 1)")
      ->type_name("N");
  command
      .add_option("--out", out,
                  "The log, one of " + formats::writable_suffixes() +
                      "; its truth goes to LOG.tum and LOG.truth.toml")
      ->required()
      ->type_name("LOG.rawlog");
  common.add_to(command);
}

Result<ExitCode> SimulateCommand::run() const {
  const Result<std::uint64_t> drawn_from = seed_from_text(seed);
  if (!drawn_from) return tl::make_unexpected(drawn_from.error());
  const Result<formats::LogFormat> format = check_out(out);
  if (!format) return tl::make_unexpected(format.error());
  const Result<simulation::Scenario> read = simulation::load_scenario(scenario);
  if (!read) return tl::make_unexpected(read.error());
  const Result<simulation::Simulated> simulated = simulation::simulate(*read, *drawn_from);
  if (!simulated) return tl::make_unexpected(simulated.error());
  if (const Result<void> written = write_all(*simulated, out); !written) {
    return tl::make_unexpected(written.error());
  }
  say_losses(simulated->log, *format, common);
  common.say(fmt::format("{}: {} seed {}, {}, {:.1f} s", out, read->name, *drawn_from,
                         text_of_held(simulated->log, *format), simulated->log.duration_s()));
  return runner::kExitDone;
}

}  // namespace corridor::cli
