#include "bench/cli/convert_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Option.hpp>

#include "bench/runner/exit_code.hpp"
#include "datasets/formats/log_io.hpp"

namespace corridor::cli {

void ConvertCommand::add_to(CLI::App& command) {
  command.add_option("in", in, "Log, or name of a data set")->required()->type_name("IN");
  command.add_option("out", out, "Log to write: .rawlog, .clf, .clf.gz; its truth goes to OUT.tum")
      ->required()
      ->type_name("OUT");
  common.add_to(command);
}

Result<ExitCode> ConvertCommand::run() const {
  const auto target = formats::format_from_suffix(out);
  if (!target) {
    return fail(ErrorCode::kUnsupported, "the suffix names no log format", out,
                ".rawlog, .clf or .clf.gz");
  }
  if (const Result<void> folder = check_parent_folder(out); !folder) {
    return tl::make_unexpected(folder.error());
  }
  const Result<catalog::LoadedDataset> loaded = catalog::load_dataset(in, common.data_dirs());
  if (!loaded) return tl::make_unexpected(loaded.error());
  if (const Result<void> written = formats::write_log(loaded->log, out); !written) {
    return tl::make_unexpected(written.error());
  }
  const std::vector<std::string> losses = formats::losses_of_conversion(loaded->log, *target);
  for (const std::string& loss : losses) common.say(fmt::format("lost: {}", loss));
  common.say(fmt::format("{}: {} scans, {} wheel samples, {} inertial samples{}", out,
                         loaded->log.num_scans(), loaded->log.num_wheel_samples(),
                         loaded->log.num_imu_samples(), losses.empty() ? ", nothing lost" : ""));
  return runner::kExitDone;
}

}  // namespace corridor::cli
