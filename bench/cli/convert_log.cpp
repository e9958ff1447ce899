#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "bench/cli/conversions.hpp"
#include "bench/cli/log_output.hpp"
#include "bench/cli/staged_files.hpp"
#include "bench/runner/case_data.hpp"
#include "bench/runner/exit_code.hpp"
#include "datasets/formats/log_health.hpp"
#include "datasets/formats/log_io.hpp"

namespace corridor::cli {
namespace {

namespace fs = std::filesystem;

// A file beside a log that says more about it.
struct Companion {
  fs::path source;
  fs::path target;
  bool is_brought = false;  // IN has it
};

std::vector<Companion> companions_of(const catalog::LoadedDataset& in, const fs::path& out) {
  const fs::path log = in.log.provenance.source;
  const auto companion = [&](const char* suffix, bool is_brought) {
    return Companion{formats::sidecar_of(log, suffix), formats::sidecar_of(out, suffix),
                     is_brought};
  };
  const bool has_reference = in.log.truth && in.log.provenance.is_truth_reference;
  return {companion(".tum", in.log.truth && !has_reference),
          companion(".reference.tum", has_reference),
          companion(".truth.toml", in.world_file.has_value()),
          companion(".relations", in.relations.has_value())};
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored);
}

// What lies at the new log's name and is its own: what is brought, and what it shares with IN.
std::vector<fs::path> own_files(const catalog::LoadedDataset& in, const fs::path& out) {
  std::vector<fs::path> own;
  for (const Companion& file : companions_of(in, out)) {
    if (file.is_brought) own.push_back(file.target);
  }
  const fs::path robot = formats::sidecar_of(out, ".robot.toml");
  const fs::path robot_of_in = formats::sidecar_of(in.log.provenance.source, ".robot.toml");
  if (is_same_file(robot, robot_of_in)) own.push_back(robot);
  return own;
}

// The log that is read is not replaced, nor does the new one get another log's truth.
Result<void> check_convert(const catalog::LoadedDataset& in, const fs::path& out,
                           formats::LogFormat format) {
  if (is_same_file(in.log.provenance.source, out)) {
    return fail(ErrorCode::kInvalid, "this is the log that is read", out.string(), "another name");
  }
  std::vector<fs::path> targets = {out};
  for (const Companion& file : companions_of(in, out)) targets.push_back(file.target);
  if (const Result<void> good = check_targets(targets); !good) return good;
  return refuse_strangers(out, format, own_files(in, out));
}

// What belongs to IN's log.
Result<void> copy_companions(const catalog::LoadedDataset& in, const fs::path& out,
                             const StagedFiles& staged) {
  for (const Companion& file : companions_of(in, out)) {
    const fs::path hidden = staged.path_for(file.target);
    std::error_code error;
    // A log converted within its folder keeps its companions untouched.
    const bool is_there = is_same_file(file.source, file.target);
    if (is_there) fs::remove(hidden, error);
    if (is_there || !file.is_brought || fs::exists(hidden, error)) continue;
    fs::copy_file(file.source, hidden, error);
    if (!error) continue;
    return fail(ErrorCode::kUnreadable, "cannot be copied: " + error.message(),
                file.source.string());
  }
  return {};
}

// What the reader did to the readings, and what looks wrong with them: no copy carries it on.
void say_of(const SensorLog& log, const CommonOptions& common) {
  for (const std::string& note : log.provenance.notes) common.say("note: " + note);
  for (const std::string& suspicion : formats::examine(log).suspicions) {
    common.say("suspicious: " + suspicion);
  }
}

// What is lost in writing has lines of its own, what was in reading is a note.
const char* end_of(const SensorLog& log, bool is_less) {
  if (is_less) return "";
  return log.provenance.has_left_out ? ", nothing lost but what the notes leave out"
                                     : ", nothing lost";
}

}  // namespace

Result<ExitCode> convert_log(const std::string& in, const fs::path& out, bool accept_other_checksum,
                             const CommonOptions& common) {
  const Result<formats::LogFormat> target = format_to_write(out);
  if (!target) {
    Error error = target.error();
    error.expected += " (a pose graph as .g2o, .graph or .toro)";
    return tl::make_unexpected(std::move(error));
  }
  catalog::LoadOptions as_it_is;
  as_it_is.keep_lidar_clock = true;
  as_it_is.accept_other_checksum = accept_other_checksum;
  const Result<catalog::LoadedDataset> loaded =
      runner::load_dataset(in, common.data_dirs(), as_it_is);
  if (!loaded) return tl::make_unexpected(loaded.error());
  if (const Result<void> good = check_convert(*loaded, out, *target); !good) {
    return tl::make_unexpected(good.error());
  }
  const auto companions = [&](const StagedFiles& staged) {
    return copy_companions(*loaded, out, staged);
  };
  if (const Result<void> written = write_log_whole(loaded->log, out, companions); !written) {
    return tl::make_unexpected(written.error());
  }
  say_of(loaded->log, common);
  const bool is_less = say_losses(loaded->log, *target, common);
  common.say(fmt::format("{}: {}{}", out.string(), text_of_held(loaded->log, *target),
                         end_of(loaded->log, is_less)));
  return runner::kExitDone;
}

}  // namespace corridor::cli
