// Sensor logs in and out: one door for every log format of the suite.
// Reading refuses what corridor::defects() finds; it never sorts, drops or repairs without being
// asked to and without a note in the log's provenance. It knows no data set by name
// (datasets/catalog does).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/formats/bag/bag_topics.hpp"
#include "datasets/formats/raw_sensors.hpp"
#include "datasets/formats/robot_keys.hpp"
#include "slam/core/result.hpp"
#include "slam/core/sensor_log.hpp"

namespace corridor::formats {

enum class LogFormat { kCarmen, kRawlog, kRosbag, kLcm, kTicks };

// "carmen", "rawlog", "rosbag", "lcm", "ticks".
std::string_view to_text(LogFormat format);

// Known log suffixes: .clf .clf.gz .log .log.gz (CARMEN), .rawlog .rawlog.gz (MRPT), .bag (ROS 1),
// .lcm.log .lcm.log.gz .lcm .lcm.gz (LCM event log), .dat .dat.gz (ticks). A .log that begins as an
// LCM event log does is read as one.
std::optional<LogFormat> format_from_suffix(const std::filesystem::path& log);

// Logs of raw numbers (LCM, ticks) are read only.
bool is_writable(LogFormat format);

// For messages: the suffixes of all logs that are read, and of those that are written.
std::string readable_suffixes();
std::string writable_suffixes();

// The path with its known log suffix replaced: sidecar_of("a/b.clf.gz", ".tum") = "a/b.tum".
std::filesystem::path sidecar_of(const std::filesystem::path& log, std::string_view suffix);

// The other logs in the folder that have the same sidecars: a.rawlog beside a.clf.
std::vector<std::filesystem::path> namesakes_of(const std::filesystem::path& log);

// What may lie beside a log, named like it, and is taken along.
inline constexpr std::array<std::string_view, 5> kSidecarSuffixes = {
    ".robot.toml", ".tum", ".relations", ".truth.toml", ".topics.toml"};

enum class StampOrder {
  kStamp,  // a stamp that steps back is an error that names the row
  kFile,  // rows are kept as they stand; stamps are made strictly increasing by isotonic regression
};

struct ReadLogOptions {
  StampOrder order = StampOrder::kStamp;
  // CARMEN: a range of at least this is no return, and the sensor's limit for FLASER lines. Where
  // it is not given, ROBOTLASER1 lines state their own and FLASER lines take the robot model's
  // limit.
  std::optional<double> no_return_range_m;
  // Calibration for logs that carry none; a log's own model and LOG.robot.toml go before it. LCM
  // and tick logs need the wheels of either to turn ticks into odometry.
  std::optional<RobotModel> robot;
  // What somebody states of `robot`; its other values are assumed.
  RobotKeys robot_keys;
  // LCM: what the raw numbers mean; the table [raw] of LOG.robot.toml goes before it.
  RawSensors raw;
  // Readings later than this after the first are left out and counted: where a recording goes on
  // after the drive.
  std::optional<double> cut_after_s;
  LogLimits limits;
  // ROS bags: which topic is which sensor; LOG.topics.toml goes before it.
  std::optional<BagTopics> topics;
  // The suffixes of the only files that are taken along, whatever lies beside the log; without a
  // list all of kSidecarSuffixes are.
  std::optional<std::vector<std::string>> only_sidecars;
  // Whether poses that another program wrote into the log (LCM) stand in for truth where there is
  // no LOG.tum.
  bool takes_reference = true;
};

// LOG with this suffix, where it is there and is to be taken along. An Error if what is there is no
// regular file: a folder, a link that leads nowhere.
Result<std::optional<std::filesystem::path>> find_sidecar(const std::filesystem::path& log,
                                                          std::string_view suffix,
                                                          const ReadLogOptions& options);

// Reads a log, its calibration LOG.robot.toml, a bag's LOG.topics.toml and its truth LOG.tum, where
// they lie beside it. An LCM log's own poses take the place of truth where there is no LOG.tum;
// provenance says so.
Result<SensorLog> read_log(const std::filesystem::path& path, const ReadLogOptions& options = {});

// A log whatever its readings are like, for those who look for what is wrong with it.
struct LogAsFound {
  SensorLog log;  // may break every rule that defects() checks
  // Of its robot model, what the log or a calibration states; the other values are assumed.
  RobotKeys robot_keys;
  // What was lidar.time_offset_s before the reader moved the scans by it.
  double applied_time_offset_s = 0;
  // Where in the file each event stands, and in what this is counted: "line", "byte".
  std::vector<std::uint64_t> origins;
  std::string origin_unit;
  // Why read_log() refuses the truth, which `log` lacks then.
  std::optional<Error> refused_truth;
};

// As read_log(), but keeps what read_log() refuses for its readings or their stamps, and leaves out
// a truth that it refuses. What is no log of its format stays an Error.
Result<LogAsFound> read_log_as_found(const std::filesystem::path& path,
                                     const ReadLogOptions& options = {});

// The suite's own format: the robot model as TOML in the leading comment, then LIDAR, WHEELS and
// IMU observations, gzip-compressed. Stamps are rounded to 100 ns. Writes no truth.
Result<void> write_rawlog(const SensorLog& log, const std::filesystem::path& path);

// ROBOTLASER1 and ODOM lines with stamps of 9 decimals; gzip-compressed if the name ends in .gz.
// Writes no truth. An Error if the log has no scan, or no wheel sample: every laser line states the
// odometry's pose.
Result<void> write_carmen(const SensorLog& log, const std::filesystem::path& path);

// Topics /scan, /odom and /imu of a ROS 1 bag, LZ4. Writes no truth. An Error if a stamp does not
// fit ROS time.
Result<void> write_rosbag(const SensorLog& log, const std::filesystem::path& path);

// By the suffix of `path`, including truth as LOG.tum beside it. A reference that stands in for
// truth goes to LOG.reference.tum, which no reader takes for truth.
Result<void> write_log(const SensorLog& log, const std::filesystem::path& path);

struct ReadingCounts {
  std::size_t num_scans = 0;
  std::size_t num_wheel_samples = 0;
  std::size_t num_imu_samples = 0;

  bool operator==(const ReadingCounts&) const = default;
};

// What a file of this format holds of the log.
ReadingCounts readings_held(const SensorLog& log, LogFormat target);

// Reads what write_log() wrote: an Error if the suite's own reader refuses it or finds another
// number of readings than readings_held() promises.
Result<void> check_written_log(const SensorLog& log, const std::filesystem::path& path);

// What `target` cannot hold of this very log, one line each; empty = nothing is lost.
std::vector<std::string> losses_of_conversion(const SensorLog& log, LogFormat target);

}  // namespace corridor::formats
