#include "datasets/formats/log_io.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/calibration.hpp"
#include "datasets/formats/carmen.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/lcm.hpp"
#include "datasets/formats/lcm_framing.hpp"
#include "datasets/formats/parsed_log.hpp"
#include "datasets/formats/rawlog.hpp"
#include "datasets/formats/robot_toml.hpp"
#include "datasets/formats/stamp_order.hpp"
#include "datasets/formats/ticks.hpp"
#include "datasets/formats/tum.hpp"

namespace corridor::formats {
namespace {

// Longer suffixes before those they end with.
constexpr std::array<std::pair<std::string_view, LogFormat>, 12> kSuffixes = {{
    {".lcm.log.gz", LogFormat::kLcm},
    {".lcm.log", LogFormat::kLcm},
    {".lcm.gz", LogFormat::kLcm},
    {".lcm", LogFormat::kLcm},
    {".dat.gz", LogFormat::kTicks},
    {".dat", LogFormat::kTicks},
    {".clf.gz", LogFormat::kCarmen},
    {".clf", LogFormat::kCarmen},
    {".log.gz", LogFormat::kCarmen},
    {".log", LogFormat::kCarmen},
    {".rawlog.gz", LogFormat::kRawlog},
    {".rawlog", LogFormat::kRawlog},
}};
constexpr const char* kKnownNames =
    "a name that ends in .clf .log .rawlog .lcm.log .lcm or .dat, or in one of these and .gz";
// SICK LMS 200 family, the sensor of the FLASER era: codes from here on say "no return".
constexpr double kFlaserRangeMax_m = 81.0;

std::size_t known_suffix_length(std::string_view name) {
  for (const auto& [suffix, format] : kSuffixes) {
    if (name.ends_with(suffix)) return suffix.size();
  }
  return 0;
}

bool is_file(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

// LOG.robot.toml, where it lies beside the log.
struct Sidecar {
  std::string file;
  std::string text;
};

Result<std::optional<Sidecar>> read_sidecar(const std::filesystem::path& log) {
  const std::filesystem::path path = sidecar_of(log, ".robot.toml");
  if (!is_file(path)) return std::nullopt;
  auto text = read_file_bytes(path);
  if (!text) return tl::make_unexpected(text.error());
  return Sidecar{path.string(), std::move(*text)};
}

// Raw numbers need their calibration before they are readings.
Result<ParsedLog> parse_raw(std::string_view bytes, LogFormat format, const std::string& file,
                            const std::optional<Sidecar>& sidecar, const ReadLogOptions& options) {
  RobotOverride stated;
  stated.robot = options.robot.value_or(RobotModel{});
  stated.raw = options.raw;
  if (sidecar) {
    auto read = override_robot(stated.robot, sidecar->text, sidecar->file, stated.raw);
    if (!read) return tl::make_unexpected(read.error());
    stated = std::move(*read);
  }
  if (!options.robot && !stated.states_wheels) {
    return fail(ErrorCode::kInvalid, "nothing says what a tick of the wheels means", file,
                "wheels.track_m, left_m_per_tick and right_m_per_tick in " +
                    sidecar_of(file, ".robot.toml").string());
  }
  if (format == LogFormat::kTicks) return parse_ticks(bytes, file, stated.robot);
  return parse_lcm(bytes, file, {stated.raw, stated.robot});
}

Result<ParsedLog> parse(const std::filesystem::path& path, const std::optional<Sidecar>& sidecar,
                        const ReadLogOptions& options) {
  const auto format = format_from_suffix(path);
  if (!format) {
    return fail(ErrorCode::kUnsupported, "unknown kind of log", path.string(), kKnownNames);
  }
  const auto bytes = read_file_bytes(path);
  if (!bytes) return tl::make_unexpected(bytes.error());
  if (bytes->empty()) {
    return fail(ErrorCode::kMalformed, "the log is empty", path.string(), "at least one scan");
  }
  // lcm-logger names its files as CARMEN's logger does.
  const bool is_lcm = *format == LogFormat::kCarmen && begins_with_lcm_sync(*bytes);
  const LogFormat found = is_lcm ? LogFormat::kLcm : *format;
  Result<ParsedLog> parsed;
  if (found == LogFormat::kRawlog) {
    parsed = parse_rawlog(*bytes, path.string());
  } else if (found == LogFormat::kCarmen) {
    CarmenOptions carmen;
    carmen.no_return_range_m = options.no_return_range_m;
    carmen.flaser_range_max_m =
        options.robot ? options.robot->lidar.range_max_m : kFlaserRangeMax_m;
    parsed = parse_carmen(*bytes, path.string(), carmen);
  } else {
    parsed = parse_raw(*bytes, found, path.string(), sidecar, options);
  }
  if (parsed) parsed->format = to_text(found);
  return parsed;
}

Result<void> settle_order(ParsedLog& parsed, const std::string& file, StampOrder order,
                          std::vector<std::string>& notes) {
  if (order == StampOrder::kStamp) return check_stamp_order(parsed, file);
  const std::size_t num_changed = make_stamps_increase(parsed.events);
  notes.push_back(fmt::format(
      "order of the file kept: {} rows' stamps moved by isotonic regression", num_changed));
  return {};
}

Result<RobotModel> settle_calibration(ParsedLog& parsed, const std::filesystem::path& path,
                                      const std::optional<Sidecar>& sidecar,
                                      const ReadLogOptions& options,
                                      std::vector<std::string>& notes) {
  CalibrationSources sources;
  sources.caller = options.robot;
  sources.file = path.string();
  if (sidecar) {
    sources.sidecar_toml = sidecar->text;
    sources.sidecar_file = sidecar->file;
  }
  return calibrate(parsed, sources, notes);
}

// What lies beyond the cut is the end of the log: its order is settled.
void cut_after(std::vector<SensorEvent>& events, double cut_after_s,
               std::vector<std::string>& notes) {
  if (events.empty()) return;
  const Timestamp end = add_seconds(stamp_of(events.front()), cut_after_s);
  const std::size_t num_before = events.size();
  while (stamp_of(events.back()) > end) events.pop_back();
  notes.push_back(fmt::format("{} readings later than {} s after the first left out",
                              num_before - events.size(), cut_after_s));
}

Result<void> attach_truth(const std::filesystem::path& path, std::optional<Trajectory> reference,
                          SensorLog& log) {
  const std::filesystem::path tum = sidecar_of(path, ".tum");
  if (!is_file(tum)) {
    if (!reference) return {};
    log.provenance.notes.push_back(fmt::format(
        "{} poses of the log itself stand in for truth: a reference that another program found",
        reference->size()));
    log.truth = std::move(*reference);
    return {};
  }
  auto truth = read_tum(tum);
  if (!truth) return tl::make_unexpected(truth.error());
  log.truth = std::move(*truth);
  return {};
}

// One line for the user: the first defect, and how many more there are.
Result<void> refuse_defects(const SensorLog& log, const LogLimits& limits) {
  const std::vector<std::string> found = defects(log, limits);
  if (found.empty()) return {};
  const std::string more =
      found.size() > 1 ? fmt::format(" (and {} more defects)", found.size() - 1) : "";
  return fail(ErrorCode::kInvalid, found.front() + more, log.provenance.source);
}

}  // namespace

std::string_view to_text(LogFormat format) {
  switch (format) {
    case LogFormat::kCarmen:
      return "carmen";
    case LogFormat::kRawlog:
      return "rawlog";
    case LogFormat::kLcm:
      return "lcm";
    case LogFormat::kTicks:
      return "ticks";
  }
  return "unknown";
}

bool is_writable(LogFormat format) {
  return format == LogFormat::kCarmen || format == LogFormat::kRawlog;
}

std::optional<LogFormat> format_from_suffix(const std::filesystem::path& log) {
  const std::string name = log.filename().string();
  for (const auto& [suffix, format] : kSuffixes) {
    if (name.ends_with(suffix)) return format;
  }
  return std::nullopt;
}

std::filesystem::path sidecar_of(const std::filesystem::path& log, std::string_view suffix) {
  std::string name = log.filename().string();
  name.resize(name.size() - known_suffix_length(name));
  return log.parent_path() / (name + std::string(suffix));
}

Result<SensorLog> read_log(const std::filesystem::path& path, const ReadLogOptions& options) {
  const auto sidecar = read_sidecar(path);
  if (!sidecar) return tl::make_unexpected(sidecar.error());
  auto parsed = parse(path, *sidecar, options);
  if (!parsed) return tl::make_unexpected(parsed.error());
  SensorLog log;
  log.provenance.name = sidecar_of(path, "").filename().string();
  log.provenance.source = path.string();
  log.provenance.format = parsed->format;
  auto& notes = log.provenance.notes;
  for (const auto& [what, count] : parsed->counts)
    notes.push_back(fmt::format("{} {}", count, what));
  notes.insert(notes.end(), parsed->notes.begin(), parsed->notes.end());
  if (auto settled = settle_order(*parsed, path.string(), options.order, notes); !settled) {
    return tl::make_unexpected(settled.error());
  }
  if (options.cut_after_s) cut_after(parsed->events, *options.cut_after_s, notes);
  auto robot = settle_calibration(*parsed, path, *sidecar, options, notes);
  if (!robot) return tl::make_unexpected(robot.error());
  log.robot = std::move(*robot);
  log.events = std::move(parsed->events);
  if (auto attached = attach_truth(path, std::move(parsed->reference), log); !attached) {
    return tl::make_unexpected(attached.error());
  }
  if (auto sound = refuse_defects(log, options.limits); !sound) {
    return tl::make_unexpected(sound.error());
  }
  return log;
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
  const std::string text = carmen_text(log);
  if (path.extension() != ".gz") return write_file_atomically(path, text);
  const auto compressed = gzip(text);
  if (!compressed) return tl::make_unexpected(compressed.error());
  return write_file_atomically(path, *compressed);
}

Result<void> write_log(const SensorLog& log, const std::filesystem::path& path) {
  const auto format = format_from_suffix(path);
  if (!format || !is_writable(*format)) {
    return fail(
        ErrorCode::kUnsupported,
        format ? fmt::format("{} logs are read only", to_text(*format)) : "unknown kind of log",
        path.string(), "a name that ends in .clf .clf.gz .log .log.gz .rawlog or .rawlog.gz");
  }
  auto written = *format == LogFormat::kRawlog ? write_rawlog(log, path) : write_carmen(log, path);
  if (!written || !log.truth) return written;
  return write_tum(*log.truth, sidecar_of(path, ".tum"));
}

}  // namespace corridor::formats
