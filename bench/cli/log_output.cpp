#include "bench/cli/log_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <system_error>

#include "datasets/formats/file_bytes.hpp"
#include "slam/core/counted.hpp"

namespace corridor::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWayOut = "another name for the log, or that file removed";

// Every suffix of a file that is read with a log, or is written beside one.
std::vector<std::string_view> companion_suffixes() {
  std::vector<std::string_view> suffixes(formats::kSidecarSuffixes.begin(),
                                         formats::kSidecarSuffixes.end());
  suffixes.emplace_back(".reference.tum");
  return suffixes;
}

// What the file would do to a log that it does not belong to.
const char* harm_of(std::string_view suffix) {
  if (suffix == ".robot.toml") return "this file would calibrate the new log";
  if (suffix == ".topics.toml") return "this file would name the topics of the new bag";
  return "this file would pass for one of the new log";
}

Result<bool> have_same_bytes(const fs::path& a, const fs::path& b) {
  const Result<std::string> bytes_a = formats::read_file_bytes(a);
  if (!bytes_a) return tl::make_unexpected(bytes_a.error());
  const Result<std::string> bytes_b = formats::read_file_bytes(b);
  if (!bytes_b) return tl::make_unexpected(bytes_b.error());
  return *bytes_a == *bytes_b;
}

// OUT's own companions go with it; one that stays as it is harms nobody.
Result<void> check_replaced(const StagedFiles& staged, const fs::path& out) {
  const std::vector<fs::path> namesakes = formats::namesakes_of(out);
  if (fs::exists(out) && namesakes.empty()) return {};
  const std::string whose = namesakes.empty() ? "another log" : namesakes.front().string();
  for (const std::string_view suffix : companion_suffixes()) {
    const fs::path target = formats::sidecar_of(out, suffix);
    const fs::path hidden = staged.path_for(target);
    if (!fs::exists(hidden) || !fs::exists(target)) continue;
    const Result<bool> is_same = have_same_bytes(hidden, target);
    if (!is_same) return tl::make_unexpected(is_same.error());
    if (*is_same) continue;
    return fail(ErrorCode::kInvalid, fmt::format("this file of {} would be overwritten", whose),
                target.string(), kWayOut);
  }
  return {};
}

}  // namespace

Result<formats::LogFormat> format_to_write(const fs::path& out) {
  const auto format = formats::format_from_suffix(out);
  if (format && formats::is_writable(*format)) return *format;
  return fail(ErrorCode::kUnsupported, "the suffix names no log format that is written",
              out.string(), "a log as one of " + formats::writable_suffixes());
}

Result<void> refuse_strangers(const fs::path& out, formats::LogFormat format,
                              const std::vector<fs::path>& own) {
  for (const std::string_view suffix : companion_suffixes()) {
    const fs::path file = formats::sidecar_of(out, suffix);
    const bool is_read = suffix != ".topics.toml" || format == formats::LogFormat::kRosbag;
    if (!is_read || !fs::exists(file)) continue;
    if (std::find(own.begin(), own.end(), file) != own.end()) continue;
    return fail(ErrorCode::kInvalid, harm_of(suffix), file.string(), kWayOut);
  }
  return {};
}

Result<void> write_log_whole(const SensorLog& log, const fs::path& out,
                             const CompanionWriter& write_companions) {
  Result<StagedFiles> staged = StagedFiles::beside(out);
  if (!staged) return tl::make_unexpected(staged.error());
  const fs::path hidden = staged->path_for(out);
  Result<void> done = formats::write_log(log, hidden);
  if (done) done = write_companions(*staged);
  if (done) done = formats::check_written_log(log, hidden);
  if (done) done = check_replaced(*staged, out);
  if (!done) return tl::make_unexpected(staged->with_final_name(done.error()));
  return staged->commit();
}

std::string text_of_held(const SensorLog& log, formats::LogFormat format) {
  const formats::ReadingCounts held = formats::readings_held(log, format);
  std::string text = fmt::format("{}, {}", counted(held.num_scans, "scan"),
                                 counted(held.num_wheel_samples, "wheel sample"));
  if (held.num_imu_samples > 0) text += ", " + counted(held.num_imu_samples, "inertial sample");
  return text;
}

bool say_losses(const SensorLog& log, formats::LogFormat format, const CommonOptions& common) {
  const std::vector<std::string> losses = formats::losses_of_conversion(log, format);
  for (const std::string& loss : losses) common.say(fmt::format("lost: {}", loss));
  return !losses.empty();
}

}  // namespace corridor::cli
