#include "bench/cli/simulate_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Option.hpp>
#include <system_error>

#include "bench/runner/exit_code.hpp"
#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/log_io.hpp"
#include "datasets/formats/tum.hpp"
#include "datasets/simulation/scenario.hpp"
#include "datasets/simulation/simulate.hpp"

namespace corridor::cli {
namespace {

namespace fs = std::filesystem;

// LOG, LOG.tum and LOG.truth.toml; none of them if one cannot be written.
Result<void> write_all(const simulation::Simulated& simulated, const fs::path& log) {
  const fs::path truth = formats::sidecar_of(log, ".tum");
  const fs::path world = formats::sidecar_of(log, ".truth.toml");
  Result<void> done = formats::write_log(simulated.log, log);
  if (done && simulated.log.truth) done = formats::write_tum(*simulated.log.truth, truth);
  if (done) {
    const std::string text = simulation::truth_toml(simulated);
    done = formats::write_file_atomically(world, std::string_view(text));
  }
  if (!done) {
    std::error_code ignored;
    for (const fs::path& path : {log, truth, world}) fs::remove(path, ignored);
  }
  return done;
}

}  // namespace

void SimulateCommand::add_to(CLI::App& command) {
  command.add_option("scenario", scenario, "Name of a scenario, or its .toml file")
      ->required()
      ->type_name("SCENARIO");
  command.add_option("--seed", seed, "What is drawn: start, speed, errors, noise (default: 1)");
  command
      .add_option("--out", out,
                  "The log, .rawlog or .clf.gz; its truth goes to LOG.tum and LOG.truth.toml")
      ->required()
      ->type_name("LOG.rawlog");
  common.add_to(command);
}

Result<ExitCode> SimulateCommand::run() const {
  if (!formats::format_from_suffix(out)) {
    return fail(ErrorCode::kUnsupported, "the suffix names no log format", out,
                ".rawlog, .clf or .clf.gz");
  }
  if (const Result<void> folder = check_parent_folder(out); !folder) {
    return tl::make_unexpected(folder.error());
  }
  const Result<fs::path> path = simulation::find_scenario(scenario);
  if (!path) return tl::make_unexpected(path.error());
  const Result<simulation::Scenario> read = simulation::read_scenario(*path);
  if (!read) return tl::make_unexpected(read.error());
  const simulation::Simulated simulated = simulation::simulate(*read, seed);
  if (const Result<void> written = write_all(simulated, out); !written) {
    return tl::make_unexpected(written.error());
  }
  common.say(
      fmt::format("{}: {} seed {}, {} scans, {} wheel samples, {} inertial samples, {:.1f} s", out,
                  read->name, seed, simulated.log.num_scans(), simulated.log.num_wheel_samples(),
                  simulated.log.num_imu_samples(), simulated.log.duration_s()));
  return runner::kExitDone;
}

}  // namespace corridor::cli
