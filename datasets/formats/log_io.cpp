#include "datasets/formats/log_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/bag/bag.hpp"
#include "datasets/formats/calibration.hpp"
#include "datasets/formats/carmen/carmen.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/log_health.hpp"
#include "datasets/formats/log_parsers.hpp"
#include "datasets/formats/parsed_log.hpp"
#include "datasets/formats/rawlog/rawlog.hpp"
#include "datasets/formats/stamp_order.hpp"
#include "datasets/formats/tick_odometry.hpp"
#include "datasets/formats/trajectories/trajectory_texts.hpp"
#include "datasets/formats/trajectories/tum.hpp"

namespace corridor::formats {
namespace {

Result<void> settle_order(ParsedLog& parsed, const std::string& file, StampOrder order,
                          std::vector<std::string>& notes) {
  if (order == StampOrder::kStamp) return check_stamp_order(parsed, file);
  const std::size_t num_changed = make_stamps_increase(parsed.events);
  notes.push_back(fmt::format(
      "order of the file kept: {} rows' stamps moved by isotonic regression", num_changed));
  return {};
}

Result<StatedRobot> settle_calibration(ParsedLog& parsed, const std::filesystem::path& path,
                                       const std::optional<Sidecar>& sidecar,
                                       const ReadLogOptions& options,
                                       std::vector<std::string>& notes) {
  CalibrationSources sources;
  sources.caller = options.robot;
  sources.caller_keys = options.robot_keys;
  sources.file = path.string();
  if (sidecar) {
    sources.sidecar_toml = sidecar->text;
    sources.sidecar_file = sidecar->file;
  }
  return calibrate(parsed, sources, notes);
}

void note_counts(const Counts& counts, std::vector<std::string>& notes) {
  for (const auto& [what, count] : counts) notes.push_back(fmt::format("{} {}", count, what));
}

// What lies beyond the cut is the end of the log: its order is settled.
void cut_after(std::vector<SensorEvent>& events, double cut_after_s, Provenance& provenance) {
  const std::size_t num_before = events.size();
  while (events.size() > 1 &&
         seconds_between(stamp_of(events.front()), stamp_of(events.back())) > cut_after_s) {
    events.pop_back();
  }
  if (events.size() < num_before) provenance.has_left_out = true;
  provenance.notes.push_back(fmt::format("{} readings later than {} s after the first left out",
                                         num_before - events.size(), cut_after_s));
}

Result<void> attach_truth(const std::filesystem::path& path, const ReadLogOptions& options,
                          std::optional<Trajectory> reference, SensorLog& log) {
  const auto found = find_sidecar(path, ".tum", options);
  if (!found) return tl::make_unexpected(found.error());
  const auto& tum = *found;
  if (!tum) {
    if (!reference) return {};
    if (!options.takes_reference) {
      log.provenance.notes.push_back(
          fmt::format("{} poses of the log itself are not used", reference->size()));
      log.provenance.has_left_out = true;
      return {};
    }
    log.provenance.notes.push_back(fmt::format(
        "{} poses of the log itself stand in for truth: a reference that another program found",
        reference->size()));
    log.truth = std::move(*reference);
    log.provenance.is_truth_reference = true;
    return {};
  }
  const auto text = read_file_bytes(*tum);
  if (!text) return tl::make_unexpected(text.error());
  auto truth = parse_tum_trajectory(*text, tum->string());
  if (!truth) return tl::make_unexpected(truth.error());
  if (truth->trajectory.empty()) {
    return fail(ErrorCode::kMalformed, "the truth has no pose", tum->string(),
                "tum poses, or no file of this name");
  }
  for (const std::string& note : truth->notes) log.provenance.notes.push_back("truth: " + note);
  log.truth = std::move(truth->trajectory);
  return {};
}

// One line for the user: the first defect with its place, and how many more there are.
Result<void> refuse_defects(const LogAsFound& found, const LogLimits& limits) {
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  const std::vector<std::string> lines = defects(found.log, limits, kAll);
  if (lines.empty()) return {};
  const EventPlaces places{found.origins, found.origin_unit};
  const std::string more =
      lines.size() > 1 ? fmt::format(" (and {} more defects)", lines.size() - 1) : "";
  return fail(ErrorCode::kInvalid, places.placed(lines.front()) + more,
              found.log.provenance.source);
}

// What is refused besides files that are no log of their format.
enum class Refusals { kAll, kNone };

// An Error stays one, or becomes a note.
Result<void> judge(Result<void> outcome, Refusals refusals, std::vector<std::string>& notes) {
  if (outcome || refusals == Refusals::kAll) return outcome;
  notes.push_back("kept although refused: " + outcome.error().to_line());
  return {};
}

Result<LogAsFound> read(const std::filesystem::path& path, const ReadLogOptions& options,
                        Refusals refusals) {
  const auto sidecar = read_sidecar(path, options);
  if (!sidecar) return tl::make_unexpected(sidecar.error());
  auto parsed = parse_log(path, *sidecar, options);
  if (!parsed) return tl::make_unexpected(parsed.error());
  LogAsFound found;
  SensorLog& log = found.log;
  log.provenance.name = sidecar_of(path, "").filename().string();
  log.provenance.source = path.string();
  log.provenance.format = parsed->format;
  auto& notes = log.provenance.notes;
  note_counts(parsed->counts, notes);
  notes.insert(notes.end(), parsed->notes.begin(), parsed->notes.end());
  auto settled = judge(settle_order(*parsed, path.string(), options.order, notes), refusals, notes);
  if (!settled) return tl::make_unexpected(settled.error());
  if (options.cut_after_s) cut_after(parsed->events, *options.cut_after_s, log.provenance);
  auto stated = settle_calibration(*parsed, path, *sidecar, options, notes);
  if (!stated) return tl::make_unexpected(stated.error());
  note_counts(parsed->left_out, notes);
  if (!parsed->left_out.empty()) log.provenance.has_left_out = true;
  log.robot = std::move(stated->robot);
  found.robot_keys = std::move(stated->keys);
  found.applied_time_offset_s = stated->applied_time_offset_s;
  log.events = std::move(parsed->events);
  if (parsed->has_wheel_ticks_only) {
    auto integrated =
        judge(integrate_wheel_ticks(log.events, log.robot.wheels, path.string()), refusals, notes);
    if (!integrated) return tl::make_unexpected(integrated.error());
  }
  const auto attached = attach_truth(path, options, std::move(parsed->reference), log);
  if (!attached && refusals == Refusals::kAll) return tl::make_unexpected(attached.error());
  if (!attached) found.refused_truth = attached.error();
  found.origins = std::move(parsed->origins);
  found.origins.resize(log.events.size());  // less what lies behind the cut
  found.origin_unit = parsed->origin_unit;
  return found;
}

}  // namespace

Result<std::optional<std::filesystem::path>> find_sidecar(const std::filesystem::path& log,
                                                          std::string_view suffix,
                                                          const ReadLogOptions& options) {
  const auto& only = options.only_sidecars;
  if (only && std::find(only->begin(), only->end(), suffix) == only->end()) return std::nullopt;
  std::filesystem::path path = sidecar_of(log, suffix);
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error)) return path;
  if (!std::filesystem::exists(std::filesystem::symlink_status(path, error))) return std::nullopt;
  return fail(ErrorCode::kUnreadable, "this is no regular file", path.string(),
              "a file that belongs to the log, or nothing of this name");
}

Result<LogAsFound> read_log_as_found(const std::filesystem::path& path,
                                     const ReadLogOptions& options) {
  return read(path, options, Refusals::kNone);
}

Result<SensorLog> read_log(const std::filesystem::path& path, const ReadLogOptions& options) {
  auto found = read(path, options, Refusals::kAll);
  if (!found) return tl::make_unexpected(found.error());
  if (auto sound = refuse_defects(*found, options.limits); !sound) {
    return tl::make_unexpected(sound.error());
  }
  return std::move(found->log);
}

Result<void> write_rawlog(const SensorLog& log, const std::filesystem::path& path) {
  auto bytes = rawlog_bytes(log);
  if (!bytes) return tl::make_unexpected(bytes.error());
  const auto compressed = gzip(*bytes);
  if (!compressed) return tl::make_unexpected(compressed.error());
  return write_file_atomically(path, *compressed);
}

Result<void> write_carmen(const SensorLog& log, const std::filesystem::path& path) {
  if (log.num_scans() == 0) {
    return fail(ErrorCode::kInvalid, "the log has no scan", path.string(), "at least one");
  }
  if (log.num_wheel_samples() == 0) {
    return fail(ErrorCode::kUnsupported, "the log has no wheel sample", path.string(),
                "odometry for CARMEN's laser lines, or another format");
  }
  const std::string text = carmen_text(log);
  if (path.extension() != ".gz") return write_file_atomically(path, text);
  const auto compressed = gzip(text);
  if (!compressed) return tl::make_unexpected(compressed.error());
  return write_file_atomically(path, *compressed);
}

Result<void> write_rosbag(const SensorLog& log, const std::filesystem::path& path) {
  return write_bag_file(log, path);
}

Result<void> write_log(const SensorLog& log, const std::filesystem::path& path) {
  const auto format = format_from_suffix(path);
  if (!format || !is_writable(*format)) {
    return fail(
        ErrorCode::kUnsupported,
        format ? fmt::format("{} logs are read only", to_text(*format)) : "unknown kind of log",
        path.string(), "a name that ends in one of " + writable_suffixes());
  }
  auto written = *format == LogFormat::kRawlog   ? write_rawlog(log, path)
                 : *format == LogFormat::kRosbag ? write_rosbag(log, path)
                                                 : write_carmen(log, path);
  if (!written || !log.truth) return written;
  return write_tum(*log.truth,
                   sidecar_of(path, log.provenance.is_truth_reference ? ".reference.tum" : ".tum"));
}

}  // namespace corridor::formats
