#include "bench/cli/simulate_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Option.hpp>
#include <cstdint>
#include <string_view>
#include <vector>

#include "bench/cli/staged_files.hpp"
#include "bench/runner/exit_code.hpp"
#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/log_io.hpp"
#include "datasets/simulation/scenario.hpp"
#include "datasets/simulation/simulate.hpp"

namespace corridor::cli {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(const fs::path& log) {
  return {log, formats::sidecar_of(log, ".tum"), formats::sidecar_of(log, ".truth.toml")};
}

// LOG, LOG.tum and LOG.truth.toml; none of them if one cannot be written.
Result<void> write_all(const simulation::Simulated& simulated, const fs::path& log) {
  Result<StagedFiles> staged = StagedFiles::beside(log);
  if (!staged) return tl::make_unexpected(staged.error());
  const fs::path hidden = staged->path_for(log);
  Result<void> done = formats::write_log(simulated.log, hidden);
  if (done) {
    const std::string text = simulation::truth_toml(simulated);
    done = formats::write_file_atomically(formats::sidecar_of(hidden, ".truth.toml"),
                                          std::string_view(text));
  }
  if (!done) return tl::make_unexpected(staged->with_final_name(done.error()));
  return staged->commit();
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
                  "The log, .rawlog or .clf.gz; its truth goes to LOG.tum and LOG.truth.toml")
      ->required()
      ->type_name("LOG.rawlog");
  common.add_to(command);
}

Result<ExitCode> SimulateCommand::run() const {
  const Result<std::uint64_t> drawn_from = seed_from_text(seed);
  if (!drawn_from) return tl::make_unexpected(drawn_from.error());
  const auto format = formats::format_from_suffix(out);
  if (!format || !formats::is_writable(*format)) {
    return fail(ErrorCode::kUnsupported, "the suffix names no log format that is written", out,
                ".rawlog, .clf or .clf.gz");
  }
  if (const Result<void> good = check_targets(files_of(out)); !good) {
    return tl::make_unexpected(good.error());
  }
  const Result<simulation::Scenario> read = simulation::load_scenario(scenario);
  if (!read) return tl::make_unexpected(read.error());
  const Result<simulation::Simulated> simulated = simulation::simulate(*read, *drawn_from);
  if (!simulated) return tl::make_unexpected(simulated.error());
  if (const Result<void> written = write_all(*simulated, out); !written) {
    return tl::make_unexpected(written.error());
  }
  common.say(fmt::format(
      "{}: {} seed {}, {} scans, {} wheel samples, {} inertial samples, {:.1f} s", out, read->name,
      *drawn_from, simulated->log.num_scans(), simulated->log.num_wheel_samples(),
      simulated->log.num_imu_samples(), simulated->log.duration_s()));
  return runner::kExitDone;
}

}  // namespace corridor::cli
