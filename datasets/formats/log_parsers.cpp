#include "datasets/formats/log_parsers.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "datasets/formats/bag/bag.hpp"
#include "datasets/formats/carmen/carmen.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/lcm/lcm.hpp"
#include "datasets/formats/lcm/lcm_framing.hpp"
#include "datasets/formats/rawlog/rawlog.hpp"
#include "datasets/formats/robot_toml.hpp"
#include "datasets/formats/ticks.hpp"

namespace corridor::formats {
namespace {

// SICK LMS 200 family, the sensor of the FLASER era: codes from here on say "no return".
constexpr double kFlaserRangeMax_m = 81.0;

Result<ParsedLog> parse_flaser_or_robotlaser(std::string_view bytes, const std::string& file,
                                             const ReadLogOptions& options) {
  CarmenOptions carmen;
  carmen.no_return_range_m = options.no_return_range_m;
  carmen.flaser_range_max_m = options.robot ? options.robot->lidar.range_max_m : kFlaserRangeMax_m;
  auto parsed = parse_carmen(bytes, file, carmen);
  const bool has_flaser_lines = parsed && !parsed->scans_state_pose;
  if (has_flaser_lines && !options.no_return_range_m && !options.robot) {
    parsed->notes.push_back(fmt::format(
        "FLASER lines state no limit: {} m is assumed, which may take codes for returns",
        carmen.flaser_range_max_m));
  }
  return parsed;
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
  const RawClock other = format == LogFormat::kTicks ? RawClock::kEventOffset : RawClock::kScanRate;
  if (stated.raw.clock == other) {
    return fail(
        ErrorCode::kInvalid, "raw.clock is one that logs of this format do not have", file,
        format == LogFormat::kTicks ? R"("data" or "scan-rate")" : R"("data" or "event-offset")");
  }
  auto parsed = format == LogFormat::kTicks
                    ? parse_ticks(bytes, file, stated.robot, stated.raw.clock)
                    : parse_lcm(bytes, file, {stated.raw, stated.robot});
  // What is no log of the format needs no calibration; its readings may look wrong for lack of one.
  const bool is_of_format = parsed || parsed.error().code == ErrorCode::kInvalid;
  if (is_of_format && !options.robot && !stated.states_wheels) {
    return fail(ErrorCode::kInvalid, "nothing says what a tick of the wheels means", file,
                "wheels.track_m, left_m_per_tick and right_m_per_tick in " +
                    sidecar_of(file, ".robot.toml").string());
  }
  const bool is_limit_stated = options.robot || stated.states_range_max;
  if (parsed && format == LogFormat::kTicks && !is_limit_stated) {
    parsed->notes.push_back(
        fmt::format("tick logs state no limit: {} m is assumed, which may take codes for returns",
                    stated.robot.lidar.range_max_m));
  }
  return parsed;
}

Result<BagTopics> topics_of(const std::filesystem::path& path, const ReadLogOptions& options) {
  const auto sidecar = find_sidecar(path, ".topics.toml", options);
  if (!sidecar) return tl::make_unexpected(sidecar.error());
  if (!*sidecar) return options.topics.value_or(BagTopics{});
  const auto text = read_file_bytes(**sidecar);
  if (!text) return tl::make_unexpected(text.error());
  return bag_topics_from_toml(*text, (*sidecar)->string());
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

// lcm-logger names its files as CARMEN's logger does.
bool is_suffix_of_two_formats(const std::filesystem::path& log) {
  const std::string name = log.filename().string();
  return name.ends_with(".log") || name.ends_with(".log.gz");
}

}  // namespace

Result<std::optional<Sidecar>> read_sidecar(const std::filesystem::path& log,
                                            const ReadLogOptions& options) {
  const auto path = find_sidecar(log, ".robot.toml", options);
  if (!path) return tl::make_unexpected(path.error());
  if (!*path) return std::nullopt;
  auto text = read_file_bytes(**path);
  if (!text) return tl::make_unexpected(text.error());
  return Sidecar{(*path)->string(), std::move(*text)};
}

Result<ParsedLog> parse_log(const std::filesystem::path& path,
                            const std::optional<Sidecar>& sidecar, const ReadLogOptions& options) {
  const auto format = format_from_suffix(path);
  if (!format) {
    return fail(ErrorCode::kUnsupported, "unknown kind of log", path.string(),
                "a name that ends in one of " + readable_suffixes());
  }
  const auto bytes = read_file_bytes(path);
  if (!bytes) return tl::make_unexpected(bytes.error());
  if (bytes->empty()) {
    return fail(ErrorCode::kMalformed, "the log is empty", path.string(), "at least one scan");
  }
  const bool is_lcm = begins_with_lcm_sync(*bytes);
  if (is_lcm && *format != LogFormat::kLcm && !is_suffix_of_two_formats(path)) {
    return fail(ErrorCode::kMalformed, "the file begins as an LCM event log does", path.string(),
                fmt::format("a {} log, or a name that ends in .lcm", to_text(*format)));
  }
  const LogFormat found = is_lcm ? LogFormat::kLcm : *format;
  const auto parse = [&]() -> Result<ParsedLog> {
    switch (found) {
      case LogFormat::kRawlog:
        return parse_rawlog(*bytes, path.string());
      case LogFormat::kCarmen:
        return parse_flaser_or_robotlaser(*bytes, path.string(), options);
      case LogFormat::kRosbag:
        return parse_rosbag(*bytes, path, options);
      case LogFormat::kLcm:
      case LogFormat::kTicks:
        return parse_raw(*bytes, found, path.string(), sidecar, options);
    }
    return fail(ErrorCode::kInternal, "no parser", path.string());
  };
  Result<ParsedLog> parsed = parse();
  if (parsed) parsed->format = to_text(found);
  return parsed;
}

}  // namespace corridor::formats
