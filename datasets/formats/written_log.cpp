// What a log file was written to hold, and whether the suite's own reader finds it there.
#include <fmt/format.h>

#include "datasets/formats/carmen/carmen.hpp"
#include "datasets/formats/log_io.hpp"

namespace corridor::formats {
namespace {

// Each laser line of a CARMEN log brings a wheel sample where none has its stamp.
std::size_t num_carmen_wheel_samples(const SensorLog& log) {
  std::size_t count = 0;
  const WheelSample* last = nullptr;
  for (const SensorEvent* event : carmen_events(log)) {
    const auto* sample = std::get_if<WheelSample>(event);
    if (sample != nullptr) last = sample;
    if (sample != nullptr || last == nullptr || last->stamp != stamp_of(*event)) ++count;
  }
  return count;
}

std::string text_of(const ReadingCounts& counts) {
  return fmt::format("{} scans, {} wheel samples, {} inertial samples", counts.num_scans,
                     counts.num_wheel_samples, counts.num_imu_samples);
}

}  // namespace

ReadingCounts readings_held(const SensorLog& log, LogFormat target) {
  ReadingCounts counts{log.num_scans(), log.num_wheel_samples(), log.num_imu_samples()};
  if (target == LogFormat::kCarmen) {
    counts.num_imu_samples = 0;
    counts.num_wheel_samples = num_carmen_wheel_samples(log);
  }
  return counts;
}

Result<void> check_written_log(const SensorLog& log, const std::filesystem::path& path) {
  const auto format = format_from_suffix(path);
  if (!format) {
    return fail(ErrorCode::kUnsupported, "unknown kind of log", path.string(),
                "a name that ends in one of " + writable_suffixes());
  }
  const auto read = read_log(path);
  if (!read) {
    return fail(read.error().code, "the format cannot hold this log: " + read.error().what,
                read.error().where, read.error().expected);
  }
  const ReadingCounts promised = readings_held(log, *format);
  const ReadingCounts found{read->num_scans(), read->num_wheel_samples(), read->num_imu_samples()};
  if (found == promised) return {};
  return fail(ErrorCode::kUnsupported, "read again, the file gives " + text_of(found),
              path.string(), text_of(promised));
}

}  // namespace corridor::formats
