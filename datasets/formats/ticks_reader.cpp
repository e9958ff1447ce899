#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "datasets/formats/even_stamps.hpp"
#include "datasets/formats/sensor_merge.hpp"
#include "datasets/formats/text.hpp"
#include "datasets/formats/tick_odometry.hpp"
#include "datasets/formats/ticks.hpp"

namespace corridor::formats {
namespace {

constexpr std::size_t kNumTokens = 707;
constexpr std::size_t kLeftToken = 2;
constexpr std::size_t kRightToken = 3;
constexpr std::size_t kFirstRangeToken = 24;
constexpr std::size_t kNumRanges = 682;
constexpr std::size_t kFirstBeam = 70;
constexpr std::size_t kLastBeam = 612;
// Hokuyo URG-04LX: the step between beams, and the least number that is a range.
constexpr double kStep_rad = 2 * std::numbers::pi / 1024;
constexpr std::int64_t kFirstRange_mm = 20;
constexpr std::int64_t kMaxRange_mm = 65'535;
constexpr double kMetresPerMillimetre = 1e-3;
constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;
// The year 2096, and more turns than a wheel lasts: beyond lie broken numbers.
constexpr std::int64_t kMaxStamp_us = 4'000'000'000'000'000;
constexpr std::int64_t kMaxTicks = 1'000'000'000'000;
constexpr int kMaxPeriodsOff = 3;

class TicksParser {
 public:
  TicksParser(const std::string& file, const RobotModel& robot, RawClock clock)
      : file_(file), robot_(robot), clock_(clock), wheels_(robot.wheels) {
    log_.origin_unit = "line";
    log_.scans_state_pose = false;
    log_.scans_state_range_max = false;
    log_.is_time_offset_applied = true;
  }

  Result<void> take(std::string_view line, std::uint64_t line_number) {
    line_number_ = line_number;
    error_.reset();
    if (!split(line)) return tl::make_unexpected(*error_);
    const Timestamp stamp{number("stamp", 0, 0, kMaxStamp_us) * kNanosecondsPerMicrosecond};
    const WheelTicks ticks{number("left ticks", kLeftToken, -kMaxTicks, kMaxTicks),
                           number("right ticks", kRightToken, -kMaxTicks, kMaxTicks)};
    LaserScan scan = take_scan();
    if (error_) return tl::make_unexpected(*error_);
    scan.stamp = add_seconds(stamp, -robot_.lidar.time_offset_s);
    const auto sample = wheels_.take(stamp, ticks, where());
    if (!sample) return tl::make_unexpected(sample.error());
    log_.add(*sample, line_number);
    log_.add(std::move(scan), line_number);
    count_left_out();
    return {};
  }

  Result<ParsedLog> finish() {
    if (clock_ == RawClock::kScanRate) {
      if (auto even = put_scans_onto_rate(); !even) return tl::make_unexpected(even.error());
    }
    if (robot_.lidar.time_offset_s != 0) {
      log_.notes.push_back(fmt::format("scans stamped {} s earlier than their rows, as calibrated",
                                       robot_.lidar.time_offset_s));
    }
    if (robot_.lidar.time_offset_s != 0 || clock_ == RawClock::kScanRate) merge_sensors(log_);
    return std::move(log_);
  }

 private:
  Result<void> put_scans_onto_rate() {
    std::vector<LaserScan*> scans;
    std::vector<Timestamp> stamps;
    for (SensorEvent& event : log_.events) {
      auto* scan = std::get_if<LaserScan>(&event);
      if (scan == nullptr) continue;
      scans.push_back(scan);
      stamps.push_back(scan->stamp);
    }
    if (stamps.size() < 2) return {};
    const EvenStamps even = even_stamps(stamps);
    if (even.largest_move_s > kMaxPeriodsOff * even.period_s) {
      // A row holds a reading of the wheels and a scan: the scan's line is its number in order.
      return fail(ErrorCode::kMalformed,
                  fmt::format("a scan {:.3f} s off a constant rate of one in {:.4f} s",
                              even.largest_move_s, even.period_s),
                  fmt::format("{}:{}", file_, even.most_moved + 1),
                  fmt::format("at most {} periods, or raw.clock = \"data\"", kMaxPeriodsOff));
    }
    for (std::size_t i = 0; i < scans.size(); ++i) scans[i]->stamp = even.stamps[i];
    log_.notes.push_back(
        fmt::format("scans put onto a constant rate of one in {:.5f} s, moved by {:.3f} s at most",
                    even.period_s, even.largest_move_s));
    return {};
  }

  void refuse(std::string what, std::string expected) {
    if (error_) return;
    error_ = Error{ErrorCode::kMalformed, std::move(what), where(), std::move(expected)};
  }

  [[nodiscard]] std::string where() const { return fmt::format("{}:{}", file_, line_number_); }

  // Reads no further than one token too many.
  bool split(std::string_view line) {
    tokens_.clear();
    while (tokens_.size() <= kNumTokens) {
      const std::string_view token = take_field(line);
      if (token.empty()) break;
      tokens_.push_back(token);
    }
    if (tokens_.size() == kNumTokens) return true;
    const bool is_longer = tokens_.size() > kNumTokens;
    refuse(is_longer ? fmt::format("more than {} tokens", kNumTokens)
                     : fmt::format("{} tokens", tokens_.size()),
           fmt::format("{}: stamp, ticks and {} ranges", kNumTokens, kNumRanges));
    return false;
  }

  std::int64_t number(const char* name, std::size_t token, std::int64_t min, std::int64_t max) {
    const auto value = parse_integer(tokens_[token]);
    if (value && *value >= min && *value <= max) return *value;
    refuse(fmt::format("{} {} (token {})", name, quote(tokens_[token]), token),
           fmt::format("a whole number from {} to {}", min, max));
    return 0;
  }

  LaserScan take_scan() {
    LaserScan scan;
    scan.angle_increment_rad = kStep_rad;
    scan.angle_min_rad =
        (static_cast<double>(kFirstBeam) - 0.5 * static_cast<double>(kNumRanges - 1)) * kStep_rad;
    scan.range_max_m = robot_.lidar.range_max_m;
    for (std::size_t beam = 0; beam < kNumRanges && !error_; ++beam) {
      const std::int64_t range_mm = number("range", kFirstRangeToken + beam, 0, kMaxRange_mm);
      if (beam < kFirstBeam || beam > kLastBeam) continue;
      const double range_m = static_cast<double>(range_mm) * kMetresPerMillimetre;
      scan.ranges_m.push_back(static_cast<float>(range_m));
      // The limit as a double may be less than the range as a float.
      const double longer_m = std::max(range_m, static_cast<double>(scan.ranges_m.back()));
      const bool is_return = range_mm >= kFirstRange_mm && longer_m <= scan.range_max_m;
      if (!is_return) count_code_or_range(range_mm, longer_m);
      scan.is_valid.push_back(is_return ? 1 : 0);
    }
    return scan;
  }

  void count_code_or_range(std::int64_t range_mm, double range_m) {
    if (range_mm > 0 && range_mm < kFirstRange_mm) {
      ++log_.counts["beams with an error code of the LiDAR taken as no return"];
    } else {
      count_no_return(range_m, robot_.lidar.range_max_m, log_.counts);
    }
  }

  // The tokens that are neither stamp, ticks nor range, where they say anything.
  void count_left_out() {
    const auto says_something = [](std::string_view token) { return token != "0"; };
    const auto first_range = tokens_.begin() + kFirstRangeToken;
    const bool has_more =
        says_something(tokens_[1]) || says_something(tokens_.back()) ||
        std::any_of(tokens_.begin() + kRightToken + 1, first_range, says_something);
    if (has_more) ++log_.left_out["rows with numbers besides stamp, ticks and ranges: left out"];
    const auto last_beam = first_range + kLastBeam;
    const bool has_outer = std::any_of(first_range, first_range + kFirstBeam, says_something) ||
                           std::any_of(last_beam + 1, tokens_.end() - 1, says_something);
    if (has_outer) ++log_.left_out["rows with ranges beside the LiDAR's field of view: left out"];
  }

  const std::string& file_;
  const RobotModel& robot_;
  RawClock clock_;
  TickOdometry wheels_;
  ParsedLog log_;
  std::uint64_t line_number_ = 0;
  std::vector<std::string_view> tokens_;
  std::optional<Error> error_;
};

}  // namespace

Result<ParsedLog> parse_ticks(std::string_view text, const std::string& file,
                              const RobotModel& robot, RawClock clock) {
  const auto note = note_on_end(text);
  TicksParser parser(file, robot, clock);
  std::uint64_t line_number = 0;
  while (const auto line = take_line(text)) {
    if (auto taken = parser.take(*line, ++line_number); !taken) {
      return tl::make_unexpected(taken.error());
    }
  }
  Result<ParsedLog> log = parser.finish();
  if (log && note) log->notes.push_back(*note);
  return log;
}

}  // namespace corridor::formats
