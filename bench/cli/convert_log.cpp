#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <vector>

#include "bench/cli/conversions.hpp"
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

// The log that is read is not replaced, nor does the new one get another log's truth.
Result<void> check_convert(const catalog::LoadedDataset& in, const fs::path& out) {
  if (is_same_file(in.log.provenance.source, out)) {
    return fail(ErrorCode::kInvalid, "this is the log that is read", out.string(), "another name");
  }
  for (const Companion& file : companions_of(in, out)) {
    if (const Result<void> good = check_targets({file.target}); !good) return good;
    if (file.is_brought || !fs::exists(file.target)) continue;
    return fail(ErrorCode::kInvalid, "this file would pass for one of the new log",
                file.target.string(), "another name for the log, or that file removed");
  }
  const fs::path robot = formats::sidecar_of(out, ".robot.toml");
  const bool is_own =
      is_same_file(robot, formats::sidecar_of(in.log.provenance.source, ".robot.toml"));
  if (fs::exists(robot) && !is_own) {
    return fail(ErrorCode::kInvalid, "this file would calibrate the new log", robot.string(),
                "another name for the log, or that file removed");
  }
  const fs::path topics = formats::sidecar_of(out, ".topics.toml");
  if (formats::format_from_suffix(out) == formats::LogFormat::kRosbag && fs::exists(topics)) {
    return fail(ErrorCode::kInvalid, "this file would name the topics of the new bag",
                topics.string(), "another name for the bag, or that file removed");
  }
  return check_targets({out});
}

// OUT with what belongs to IN's log beside it; all or nothing.
Result<void> write_all(const catalog::LoadedDataset& in, const fs::path& out) {
  Result<StagedFiles> staged = StagedFiles::beside(out);
  if (!staged) return tl::make_unexpected(staged.error());
  const Result<void> written = formats::write_log(in.log, staged->path_for(out));
  if (!written) return tl::make_unexpected(staged->with_final_name(written.error()));
  for (const Companion& file : companions_of(in, out)) {
    const fs::path hidden = staged->path_for(file.target);
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
  const Result<void> good = formats::check_written_log(in.log, staged->path_for(out));
  if (!good) return tl::make_unexpected(staged->with_final_name(good.error()));
  return staged->commit();
}

// What the reader did to the readings, and what looks wrong with them: no copy carries it on.
void say_of(const SensorLog& log, const CommonOptions& common) {
  for (const std::string& note : log.provenance.notes) common.say("note: " + note);
  for (const std::string& suspicion : formats::examine(log).suspicions) {
    common.say("suspicious: " + suspicion);
  }
}

std::string text_of(const formats::ReadingCounts& held) {
  std::string text =
      fmt::format("{} scans, {} wheel samples", held.num_scans, held.num_wheel_samples);
  if (held.num_imu_samples > 0) text += fmt::format(", {} inertial samples", held.num_imu_samples);
  return text;
}

// What is lost in writing has lines of its own, what was in reading is a note.
std::string end_of(const SensorLog& log, const std::vector<std::string>& losses) {
  if (!losses.empty()) return "";
  return log.provenance.has_left_out ? ", nothing lost but what the notes leave out"
                                     : ", nothing lost";
}

}  // namespace

Result<ExitCode> convert_log(const std::string& in, const fs::path& out, bool accept_other_checksum,
                             const CommonOptions& common) {
  const auto target = formats::format_from_suffix(out);
  if (!target || !formats::is_writable(*target)) {
    return fail(ErrorCode::kUnsupported, "the suffix names no log format that is written",
                out.string(),
                "a log as .rawlog, .clf, .clf.gz or .bag (a pose graph as .g2o, .graph or .toro)");
  }
  catalog::LoadOptions as_it_is;
  as_it_is.keep_lidar_clock = true;
  as_it_is.accept_other_checksum = accept_other_checksum;
  const Result<catalog::LoadedDataset> loaded =
      runner::load_dataset(in, common.data_dirs(), as_it_is);
  if (!loaded) return tl::make_unexpected(loaded.error());
  if (const Result<void> good = check_convert(*loaded, out); !good) {
    return tl::make_unexpected(good.error());
  }
  if (const Result<void> written = write_all(*loaded, out); !written) {
    return tl::make_unexpected(written.error());
  }
  say_of(loaded->log, common);
  const std::vector<std::string> losses = formats::losses_of_conversion(loaded->log, *target);
  for (const std::string& loss : losses) common.say(fmt::format("lost: {}", loss));
  common.say(fmt::format("{}: {}{}", out.string(),
                         text_of(formats::readings_held(loaded->log, *target)),
                         end_of(loaded->log, losses)));
  return runner::kExitDone;
}

}  // namespace corridor::cli
