#include "datasets/formats/log_io.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/bag.hpp"
#include "datasets/formats/calibration.hpp"
#include "datasets/formats/carmen.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/parsed_log.hpp"
#include "datasets/formats/rawlog.hpp"
#include "datasets/formats/stamp_order.hpp"
#include "datasets/formats/tick_odometry.hpp"
#include "datasets/formats/tum.hpp"

namespace corridor::formats {
namespace {

constexpr std::array<std::pair<std::string_view, LogFormat>, 7> kSuffixes = {{
    {".clf.gz", LogFormat::kCarmen},
    {".clf", LogFormat::kCarmen},
    {".log.gz", LogFormat::kCarmen},
    {".log", LogFormat::kCarmen},
    {".rawlog.gz", LogFormat::kRawlog},
    {".rawlog", LogFormat::kRawlog},
    {".bag", LogFormat::kRosbag},
}};
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

constexpr const char* kKnownSuffixes =
    "a name that ends in .clf .clf.gz .log .log.gz .rawlog .rawlog.gz or .bag";

Result<BagTopics> topics_of(const std::filesystem::path& path, const ReadLogOptions& options) {
  const std::filesystem::path sidecar = sidecar_of(path, ".topics.toml");
  if (!is_file(sidecar)) return options.topics.value_or(BagTopics{});
  const auto text = read_file_bytes(sidecar);
  if (!text) return tl::make_unexpected(text.error());
  return bag_topics_from_toml(*text, sidecar.string());
}

Result<ParsedLog> parse_rosbag(std::string_view bytes, const std::filesystem::path& path,
                               const ReadLogOptions& options) {
  std::error_code error;
  // rosbag opens the file itself, and must find the bytes that are checked here.
  if (std::filesystem::file_size(path, error) != bytes.size()) {
    return fail(ErrorCode::kUnsupported, "the bag is compressed as a whole", path.string(),
                "a bag; its chunks may be compressed");
  }
  const auto topics = topics_of(path, options);
  if (!topics) return tl::make_unexpected(topics.error());
  return parse_bag(bytes, path, {*topics, options.order == StampOrder::kFile});
}

Result<ParsedLog> parse(const std::filesystem::path& path, const ReadLogOptions& options) {
  const auto format = format_from_suffix(path);
  if (!format) {
    return fail(ErrorCode::kUnsupported, "unknown kind of log", path.string(), kKnownSuffixes);
  }
  const auto bytes = read_file_bytes(path);
  if (!bytes) return tl::make_unexpected(bytes.error());
  if (bytes->empty()) {
    return fail(ErrorCode::kMalformed, "the log is empty", path.string(), "at least one scan");
  }
  if (*format == LogFormat::kRawlog) return parse_rawlog(*bytes, path.string());
  if (*format == LogFormat::kRosbag) return parse_rosbag(*bytes, path, options);
  CarmenOptions carmen;
  carmen.no_return_range_m = options.no_return_range_m;
  carmen.flaser_range_max_m = options.robot ? options.robot->lidar.range_max_m : kFlaserRangeMax_m;
  return parse_carmen(*bytes, path.string(), carmen);
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
                                      const ReadLogOptions& options,
                                      std::vector<std::string>& notes) {
  CalibrationSources sources;
  sources.caller = options.robot;
  sources.file = path.string();
  const std::filesystem::path sidecar = sidecar_of(path, ".robot.toml");
  if (is_file(sidecar)) {
    auto text = read_file_bytes(sidecar);
    if (!text) return tl::make_unexpected(text.error());
    sources.sidecar_toml = std::move(*text);
    sources.sidecar_file = sidecar.string();
  }
  return calibrate(parsed, sources, notes);
}

Result<void> attach_truth(const std::filesystem::path& path, SensorLog& log) {
  const std::filesystem::path tum = sidecar_of(path, ".tum");
  if (!is_file(tum)) return {};
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
  if (format == LogFormat::kRosbag) return "rosbag";
  return format == LogFormat::kCarmen ? "carmen" : "rawlog";
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
  auto parsed = parse(path, options);
  if (!parsed) return tl::make_unexpected(parsed.error());
  SensorLog log;
  log.provenance.name = sidecar_of(path, "").filename().string();
  log.provenance.source = path.string();
  log.provenance.format = to_text(*format_from_suffix(path));
  auto& notes = log.provenance.notes;
  for (const auto& [what, count] : parsed->counts)
    notes.push_back(fmt::format("{} {}", count, what));
  if (auto settled = settle_order(*parsed, path.string(), options.order, notes); !settled) {
    return tl::make_unexpected(settled.error());
  }
  auto robot = settle_calibration(*parsed, path, options, notes);
  if (!robot) return tl::make_unexpected(robot.error());
  log.robot = std::move(*robot);
  log.events = std::move(parsed->events);
  if (parsed->has_wheel_ticks_only) integrate_wheel_ticks(log.events, log.robot.wheels);
  if (auto attached = attach_truth(path, log); !attached) {
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

Result<void> write_rosbag(const SensorLog& log, const std::filesystem::path& path) {
  return write_bag_file(log, path);
}

Result<void> write_log(const SensorLog& log, const std::filesystem::path& path) {
  const auto format = format_from_suffix(path);
  if (!format) {
    return fail(ErrorCode::kUnsupported, "unknown kind of log", path.string(), kKnownSuffixes);
  }
  auto written = *format == LogFormat::kRawlog   ? write_rawlog(log, path)
                 : *format == LogFormat::kRosbag ? write_rosbag(log, path)
                                                 : write_carmen(log, path);
  if (!written || !log.truth) return written;
  return write_tum(*log.truth, sidecar_of(path, ".tum"));
}

}  // namespace corridor::formats
