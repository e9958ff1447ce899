#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "datasets/formats/carmen/carmen.hpp"
#include "datasets/formats/degree_check.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

constexpr double kHalfTurn_rad = std::numbers::pi;
// Added to a sensor's limit where a log has an infinite range: finite, and beyond the limit.
constexpr float kBeyondLimit_m = 1.0F;
constexpr std::size_t kMaxRemissions = kMaxBeams;

struct LineEnd {
  Timestamp stamp;
  bool has_more = false;  // a host, or a logger's stamp besides the message's
};

// Takes fields off one line; the first thing wrong is kept and all later answers mean nothing.
class LineReader {
 public:
  LineReader(std::string_view rest, std::string where, DegreeCheck& headings)
      : rest_(rest), where_(std::move(where)), headings_(headings) {}

  double number(const char* name) {
    const std::string_view field = take_field(rest_);
    const auto value = parse_double(field);
    if (!value || !std::isfinite(*value)) refuse(name, field, "a finite number");
    return value.value_or(0);
  }

  // Capped before anything is allocated.
  std::size_t count(const char* name, std::size_t min, std::size_t max) {
    const std::string_view field = take_field(rest_);
    const auto value = parse_integer(field);
    if (!value || *value < static_cast<std::int64_t>(min) ||
        *value > static_cast<std::int64_t>(max)) {
      refuse(name, field, fmt::format("a whole number from {} to {}", min, max).c_str());
      return min;
    }
    return static_cast<std::size_t>(*value);
  }

  Pose2 pose(const char* name) {
    const double x_m = number(name);
    const double y_m = number(name);
    const double theta_rad = number(name);
    if (!has_failed() && std::abs(theta_rad) > kMaxHeading_rad) {
      refuse(name, fmt::format("heading {}", theta_rad),
             fmt::format("at most {:g} rad", kMaxHeading_rad).c_str());
    }
    if (has_failed()) return {};
    headings_.take(theta_rad);  // as it stands: a pose wraps it
    return {x_m, y_m, theta_rad};
  }

  CarmenSpeed speed() {
    const double forward_mps = number("tv");
    return {forward_mps, number("rv")};
  }

  // A range may be infinite: no return.
  double range() {
    const std::string_view field = take_field(rest_);
    const auto value = parse_double(field);
    if (!value || std::isnan(*value) || *value < 0) refuse("range", field, "a number >= 0");
    return value.value_or(0);
  }

  // "stamp host logger_stamp" and nothing else.
  LineEnd stamp_and_end() {
    const std::string_view field = take_field(rest_);
    const auto stamp = parse_stamp(field);
    if (!stamp) refuse("stamp", field, "decimal seconds");
    const std::string_view host = take_field(rest_);
    const std::string_view logger_stamp = take_field(rest_);
    if (host.empty() || !parse_double(logger_stamp)) {
      refuse("logger stamp", logger_stamp, "'stamp host logger_stamp' at the line's end");
    }
    if (const auto more = take_field(rest_); !more.empty()) {
      refuse("field", more, "the line's end");
    }
    return {stamp.value_or(Timestamp{}), host != kCarmenHost || parse_stamp(logger_stamp) != stamp};
  }

  void refuse(const char* name, std::string_view field, const char* expected) {
    if (has_failed()) return;
    const std::string found = field.empty() ? "missing" : quote(field);
    error_ = Error{ErrorCode::kMalformed, fmt::format("{} {}", name, found), where_, expected};
  }

  [[nodiscard]] const std::string& where() const { return where_; }
  [[nodiscard]] bool has_failed() const { return error_.has_value(); }
  [[nodiscard]] const Error& error() const { return *error_; }

 private:
  std::string_view rest_;
  std::string where_;
  DegreeCheck& headings_;
  std::optional<Error> error_;
};

class CarmenParser {
 public:
  CarmenParser(const std::string& file, const CarmenOptions& options)
      : file_(file), options_(options) {
    log_.origin_unit = "line";
  }

  Result<void> take(std::string_view line, std::uint64_t line_number) {
    line_number_ = line_number;
    const std::string_view message = take_field(line);
    if (message.empty() || message.front() == '#') return {};
    LineReader reader(line, fmt::format("{}:{}", file_, line_number), headings_);
    if (message == "FLASER") {
      take_flaser(reader);
    } else if (message == "ROBOTLASER1") {
      take_robotlaser(reader);
    } else if (message == "ODOM") {
      take_odom(reader);
    } else if (is_skipped_carmen_message(message)) {
      if (auto good = check_one_message(line, reader.where()); !good) return good;
      ++log_.left_out[fmt::format("{} lines skipped", message)];
    } else {
      reader.refuse("message", message, "a CARMEN message such as FLASER, ROBOTLASER1 or ODOM");
    }
    if (reader.has_failed()) return tl::make_unexpected(reader.error());
    return {};
  }

  ParsedLog finish() {
    count_other_speeds();
    if (auto note = headings_.note()) log_.notes.push_back(std::move(*note));
    return std::move(log_);
  }

 private:
  void leave_out_if(bool is_said, const char* what) {
    if (is_said) ++log_.left_out[what];
  }

  void take_flaser(LineReader& reader) {
    log_.scans_state_pose = false;
    // The model's limit is that of the first scan.
    if (!has_scans_) log_.scans_state_range_max = options_.no_return_range_m.has_value();
    LaserScan scan;
    const std::size_t num_beams = reader.count("number of ranges", 1, kMaxBeams);
    scan.range_max_m = options_.no_return_range_m.value_or(options_.flaser_range_max_m);
    scan.angle_min_rad = -kHalfTurn_rad / 2;
    const std::size_t num_steps = num_beams % 2 == 0 ? num_beams : num_beams - 1;
    scan.angle_increment_rad = num_steps == 0 ? 0 : kHalfTurn_rad / static_cast<double>(num_steps);
    take_ranges(reader, num_beams, scan);
    // Corrected by whoever wrote the log, or the odometry once more.
    const Pose2 T_map_base = reader.pose("pose");
    const Pose2 T_odom_base = reader.pose("odometry pose");
    leave_out_if(!(T_map_base == T_odom_base), "FLASER lines lose their corrected pose");
    scan.stamp = take_stamp(reader);
    add_scan(reader, T_odom_base, std::move(scan));
  }

  void take_robotlaser(LineReader& reader) {
    LaserScan scan;
    leave_out_if(reader.number("laser type") != 0, "scans lose the type of their laser");
    scan.angle_min_rad = reader.number("start angle");
    const double field_of_view_rad = reader.number("field of view");
    scan.angle_increment_rad = reader.number("angular resolution");
    const double range_max_m = reader.number("maximum range");
    scan.range_max_m = options_.no_return_range_m.value_or(range_max_m);
    log_.stated_noise.take(reader.number("accuracy"));
    leave_out_if(reader.number("remission mode") != 0, "scans lose the mode of their remissions");
    const std::size_t num_beams = reader.count("number of ranges", 1, kMaxBeams);
    check_geometry(reader, field_of_view_rad, num_beams, scan);
    take_ranges(reader, num_beams, scan);
    const std::size_t num_remissions = reader.count("number of remissions", 0, kMaxRemissions);
    for (std::size_t i = 0; i < num_remissions && !reader.has_failed(); ++i) {
      reader.number("remission");
    }
    leave_out_if(num_remissions > 0, "scans lose their remissions");
    const Pose2 T_odom_lidar = reader.pose("laser pose");
    const Pose2 T_odom_base = reader.pose("robot pose");
    scan.T_base_lidar = mounting(T_odom_base.between(T_odom_lidar));
    const CarmenSpeed speed = reader.speed();
    bool has_safety = false;
    for (const char* name : {"forward safety distance", "side safety distance", "turn axis"}) {
      has_safety = reader.number(name) != 0 || has_safety;
    }
    leave_out_if(has_safety, "scans lose the robot's safety distances and turn axis");
    scan.stamp = take_stamp(reader);
    take_speed(reader, {scan.stamp, T_odom_base, std::nullopt}, speed);
    add_scan(reader, T_odom_base, std::move(scan));
  }

  // Two printed poses give the mounting only to their last digits: it stays what it was while a new
  // one differs by less.
  Pose2 mounting(const Pose2& T_base_lidar) {
    constexpr double kPrinted_m = 1e-4;
    constexpr double kPrinted_rad = 1e-4;
    const Pose2::Tangent change = T_base_lidar.minus(last_T_base_lidar_);
    const bool is_same =
        change.head<2>().norm() < kPrinted_m && std::abs(change.z()) < kPrinted_rad;
    if (!is_same) last_T_base_lidar_ = T_base_lidar;
    return last_T_base_lidar_;
  }

  void take_odom(LineReader& reader) {
    const Pose2 T_odom_base = reader.pose("odometry pose");
    const CarmenSpeed speed = reader.speed();
    leave_out_if(reader.number("acceleration") != 0, "ODOM lines lose their acceleration");
    const WheelSample sample{take_stamp(reader), T_odom_base, std::nullopt};
    take_speed(reader, sample, speed);
    if (!reader.has_failed()) log_.add(sample, line_number_);
  }

  Timestamp take_stamp(LineReader& reader) {
    const LineEnd end = reader.stamp_and_end();
    leave_out_if(end.has_more, "lines lose their host and the logger's stamp");
    return end.stamp;
  }

  void take_speed(const LineReader& reader, const WheelSample& line, const CarmenSpeed& speed) {
    if (reader.has_failed()) return;
    wheel_lines_.push_back(line);
    stated_speeds_.push_back(speed);
  }

  // Speeds that follow from the poses are not lost with the line.
  void count_other_speeds() {
    constexpr double kSame_ratio =
        1e-6;  // poses and stamps are printed with as many digits or more
    const auto is_same = [](double stated, double told) {
      return std::abs(stated - told) <= kSame_ratio * std::max(1.0, std::abs(told));
    };
    const std::vector<CarmenSpeed> told = carmen_speeds(wheel_lines_);
    for (std::size_t i = 0; i < told.size(); ++i) {
      const bool is_kept = is_same(stated_speeds_[i].forward_mps, told[i].forward_mps) &&
                           is_same(stated_speeds_[i].turn_radps, told[i].turn_radps);
      leave_out_if(!is_kept, "lines lose speeds (tv, rv) that are not those of their odometry");
    }
  }

  // The stated field of view spans n or n - 1 steps: a beam count that is off by one shows here.
  static void check_geometry(LineReader& reader, double field_of_view_rad, std::size_t num_beams,
                             const LaserScan& scan) {
    if (reader.has_failed()) return;
    const double num_steps = field_of_view_rad / scan.angle_increment_rad;
    const auto n = static_cast<double>(num_beams);
    if (!(scan.angle_increment_rad > 0) || !(num_steps > n - 1.5 && num_steps < n + 0.5)) {
      reader.refuse(
          "number of ranges", fmt::format("{}", num_beams),
          fmt::format("about {:.1f} for this field of view and resolution", num_steps).c_str());
    }
    if (exceeds_full_turn(num_beams, scan.angle_increment_rad)) {
      reader.refuse("field of view", fmt::format("{}", field_of_view_rad),
                    "at most 2 pi (degrees for radians?)");
    }
    if (!(scan.range_max_m > 0)) {
      reader.refuse("maximum range", fmt::format("{}", scan.range_max_m), "a number > 0");
    }
  }

  void take_ranges(LineReader& reader, std::size_t num_beams, LaserScan& scan) {
    if (reader.has_failed()) return;
    scan.ranges_m.reserve(num_beams);
    scan.is_valid.reserve(num_beams);
    for (std::size_t i = 0; i < num_beams && !reader.has_failed(); ++i) {
      const double range_m = reader.range();
      auto kept_m = static_cast<float>(range_m);
      // The limit as a double may be less than the range as a float.
      const bool is_return =
          range_m > 0 && range_m < scan.range_max_m && kept_m <= scan.range_max_m;
      if (!std::isfinite(kept_m)) {
        ++log_.counts["infinite ranges replaced by the sensor's limit + 1 m, as no return"];
        kept_m = static_cast<float>(scan.range_max_m) + kBeyondLimit_m;
      } else if (!is_return) {
        count_no_return(std::max<double>(range_m, kept_m), scan.range_max_m, log_.counts);
      }
      scan.ranges_m.push_back(kept_m);
      scan.is_valid.push_back(is_return ? 1 : 0);
    }
  }

  void add_scan(const LineReader& reader, const Pose2& T_odom_base, LaserScan scan) {
    if (reader.has_failed()) return;
    const auto* last =
        log_.events.empty() ? nullptr : std::get_if<WheelSample>(&log_.events.back());
    const bool is_known =
        last != nullptr && last->stamp == scan.stamp && last->T_odom_base == T_odom_base;
    if (!is_known) log_.add(WheelSample{scan.stamp, T_odom_base, std::nullopt}, line_number_);
    log_.add(std::move(scan), line_number_);
    has_scans_ = true;
  }

  const std::string& file_;
  const CarmenOptions& options_;
  std::uint64_t line_number_ = 0;
  bool has_scans_ = false;
  DegreeCheck headings_;
  Pose2 last_T_base_lidar_;
  // The lines that state speeds.
  std::vector<WheelSample> wheel_lines_;
  std::vector<CarmenSpeed> stated_speeds_;
  ParsedLog log_;
};

}  // namespace

Result<void> check_one_message(std::string_view fields, const std::string& where) {
  for (auto field = take_field(fields); !field.empty(); field = take_field(fields)) {
    for (const std::string_view message : {"FLASER", "ROBOTLASER1", "ODOM"}) {
      // Whatever stands for the line's end may belong to the field.
      std::string_view rest = fields;
      if (!field.ends_with(message) || !parse_double(take_field(rest))) continue;
      return fail(ErrorCode::kMalformed, fmt::format("{} within a line", message), where,
                  "one message in a line: has its end been lost?");
    }
  }
  return {};
}

Result<ParsedLog> parse_carmen(std::string_view text, const std::string& file,
                               const CarmenOptions& options) {
  const auto note = note_on_end(text);
  CarmenParser parser(file, options);
  std::uint64_t line_number = 0;
  while (const auto line = take_line(text)) {
    if (auto taken = parser.take(*line, ++line_number); !taken) {
      return tl::make_unexpected(taken.error());
    }
  }
  ParsedLog log = parser.finish();
  if (note) log.notes.push_back(*note);
  return log;
}

}  // namespace corridor::formats
