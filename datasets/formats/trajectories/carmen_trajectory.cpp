// Poses of a CARMEN log, as SLAM programs correct them in place:
//   FLASER n r_1..r_n  x y theta  odom_x odom_y odom_theta  stamp host logger_stamp
//   ROBOTLASER1 (7 numbers) n r_1..r_n m e_1..e_m  laser x y theta  x y theta  (5 numbers)  stamp
//     host logger_stamp
#include <fmt/format.h>

#include <array>
#include <map>
#include <span>
#include <utility>

#include "datasets/formats/carmen/carmen.hpp"
#include "datasets/formats/degree_check.hpp"
#include "datasets/formats/text.hpp"
#include "datasets/formats/trajectories/trajectory_rules.hpp"
#include "datasets/formats/trajectories/trajectory_texts.hpp"

namespace corridor::formats {
namespace {

using Fields = std::span<const std::string_view>;

constexpr std::size_t kNumScannerNumbers = 7;
constexpr std::size_t kNumPoseNumbers = 3;
constexpr std::size_t kNumMotionNumbers = 5;
constexpr std::size_t kNumStampFields = 3;

// Where in a line of the message the pose begins and how many fields the line has.
struct Place {
  std::size_t pose = 0;
  std::size_t num_fields = 0;
};

// The count at `index`, at most kMaxBeams.
Result<std::size_t> count_at(Fields fields, std::size_t index, const char* what,
                             const std::string& where) {
  const auto count = index < fields.size() ? parse_integer(fields[index]) : std::nullopt;
  if (!count || *count < 0 || *count > static_cast<std::int64_t>(kMaxBeams)) {
    return fail(ErrorCode::kMalformed,
                fmt::format("number of {} {}", what,
                            index < fields.size() ? quote(fields[index]) : "missing"),
                where, fmt::format("a whole number from 0 to {}", kMaxBeams));
  }
  return static_cast<std::size_t>(*count);
}

Result<Place> place_of(Fields fields, const std::string& where) {
  const bool is_flaser = fields[0] == "FLASER";
  std::size_t next = is_flaser ? 1 : 1 + kNumScannerNumbers;
  const auto num_ranges = count_at(fields, next, "ranges", where);
  if (!num_ranges) return tl::make_unexpected(num_ranges.error());
  next += 1 + *num_ranges;
  if (is_flaser) return Place{next, next + 2 * kNumPoseNumbers + kNumStampFields};
  const auto num_remissions = count_at(fields, next, "remissions", where);
  if (!num_remissions) return tl::make_unexpected(num_remissions.error());
  next += 1 + *num_remissions + kNumPoseNumbers;
  return Place{next, next + kNumPoseNumbers + kNumMotionNumbers + kNumStampFields};
}

Result<void> take_pose(Fields fields, const std::string& where, Trajectory& trajectory,
                       DegreeCheck& degrees) {
  const auto place = place_of(fields, where);
  if (!place) return tl::make_unexpected(place.error());
  if (fields.size() != place->num_fields) {
    return fail(ErrorCode::kMalformed, fmt::format("{} fields", fields.size()), where,
                fmt::format("{}: a whole {} line", place->num_fields, fields[0]));
  }
  std::array<double, kNumPoseNumbers> numbers{};
  if (auto good = parse_finite(fields.subspan(place->pose, kNumPoseNumbers), where, numbers);
      !good) {
    return good;
  }
  const std::string_view stamp_field = fields[fields.size() - kNumStampFields];
  const auto stamp = parse_stamp(stamp_field);
  if (!stamp) {
    return fail(ErrorCode::kMalformed, "stamp " + quote(stamp_field), where, "decimal seconds");
  }
  degrees.take(numbers[2]);
  return append_pose(trajectory, *stamp, Pose2(numbers[0], numbers[1], numbers[2]), stamp_field,
                     where);
}

}  // namespace

Result<ReadTrajectory> parse_carmen_trajectory(std::string_view text, const std::string& name) {
  ReadTrajectory read;
  if (auto note = note_on_end(text)) read.notes.push_back(std::move(*note));
  std::map<std::string, std::size_t, std::less<>> num_left_out;
  std::string kind;  // of the lines that give poses: the first kind that comes
  DegreeCheck degrees;
  std::size_t line_number = 0;
  while (const auto line = take_line(text)) {
    const std::string where = fmt::format("{}:{}", name, ++line_number);
    const auto fields = split_fields(*line);
    if (fields.empty() || fields[0].front() == '#') continue;
    const bool is_scan = fields[0] == "FLASER" || fields[0] == "ROBOTLASER1";
    if (!is_scan && fields[0] != "ODOM" && !is_skipped_carmen_message(fields[0])) {
      return fail(ErrorCode::kMalformed, "message " + quote(fields[0]), where,
                  "a CARMEN message such as FLASER or ROBOTLASER1");
    }
    if (is_scan && kind.empty()) kind = fields[0];
    if (fields[0] != kind) {
      std::string_view rest = *line;
      take_field(rest);
      if (auto good = check_one_message(rest, where); !good)
        return tl::make_unexpected(good.error());
      ++num_left_out[std::string(fields[0])];
      continue;
    }
    if (auto taken = take_pose(fields, where, read.trajectory, degrees); !taken) {
      return tl::make_unexpected(taken.error());
    }
  }
  for (const auto& [message, count] : num_left_out) {
    read.notes.push_back(fmt::format("{} {} lines left out", count, message));
  }
  if (auto note = degrees.note()) read.notes.push_back(std::move(*note));
  if (auto good = check_stamp_unit(read.trajectory, name, "seconds"); !good) {
    return tl::make_unexpected(good.error());
  }
  return read;
}

std::string carmen_trajectory_text(const Trajectory& trajectory) {
  std::string text = "# CARMEN trajectory: FLASER lines without beams; both poses are the same\n";
  for (const TrajectoryPose& pose : trajectory.poses()) {
    const std::string numbers = fmt::format("{} {} {}", pose.T_map_base.x_m(),
                                            pose.T_map_base.y_m(), pose.T_map_base.theta_rad());
    const std::string stamp = format_stamp(pose.stamp);
    text += fmt::format("FLASER 0 {} {} {} corridor-bench {}\n", numbers, numbers, stamp, stamp);
  }
  return text;
}

}  // namespace corridor::formats
