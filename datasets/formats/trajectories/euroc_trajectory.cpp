// EuRoC MAV ground truth: comma-separated, stamps in integer nanoseconds, quaternion with w first.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "datasets/formats/text.hpp"
#include "datasets/formats/trajectories/trajectory_rules.hpp"
#include "datasets/formats/trajectories/trajectory_texts.hpp"

namespace corridor::formats {
namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr std::size_t kNumFields = 8;
constexpr std::size_t kNumGroundTruthFields = 17;  // + velocity, gyro bias, accelerometer bias
constexpr const char* kHead =
    "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],"
    "q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []\n";

// Fields between commas, blanks around them taken off; at most kMaxLineFields.
std::vector<std::string_view> split_at_commas(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0; begin <= line.size() && fields.size() < kMaxLineFields;) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    std::string_view field = line.substr(begin, end - begin);
    field.remove_prefix(std::min(field.find_first_not_of(kBlanks), field.size()));
    field.remove_suffix(field.size() - (field.find_last_not_of(kBlanks) + 1));
    fields.push_back(field);
    begin = end + 1;
  }
  return fields;
}

struct EurocState {
  Timestamp stamp;
  Pose2 T_map_base;
  double z_m = 0;
};

Result<EurocState> parse_state(const std::vector<std::string_view>& fields,
                               const std::string& where) {
  if (fields.size() != kNumFields && fields.size() != kNumGroundTruthFields) {
    return fail(ErrorCode::kMalformed, fmt::format("{} fields", fields.size()), where,
                "8 (or 17): 'ns,tx,ty,tz,qw,qx,qy,qz'");
  }
  const auto stamp_ns = parse_integer(fields[0]);
  if (!stamp_ns || *stamp_ns < -kMaxStamp_ns || *stamp_ns > kMaxStamp_ns) {
    return fail(ErrorCode::kMalformed, "stamp " + quote(fields[0]), where,
                fmt::format("whole nanoseconds, at most {}", kMaxStamp_ns));
  }
  std::array<double, kNumGroundTruthFields - 1> numbers{};
  if (auto good = parse_finite(std::span(fields).subspan(1), where, numbers); !good) {
    return tl::make_unexpected(good.error());
  }
  const auto [x_m, y_m, z_m, qw, qx, qy, qz] = std::to_array(
      {numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5], numbers[6]});
  const auto yaw_rad = yaw_of_quaternion(qx, qy, qz, qw, where);
  if (!yaw_rad) return tl::make_unexpected(yaw_rad.error());
  return EurocState{Timestamp{*stamp_ns}, Pose2(x_m, y_m, *yaw_rad), z_m};
}

}  // namespace

Result<ReadTrajectory> parse_euroc(std::string_view text, const std::string& name) {
  ReadTrajectory read;
  if (auto note = note_on_end(text)) read.notes.push_back(std::move(*note));
  std::size_t line_number = 0;
  std::size_t num_raised = 0;
  std::size_t num_states = 0;
  while (const auto line = take_line(text)) {
    const std::string where = fmt::format("{}:{}", name, ++line_number);
    std::string_view rest = *line;
    const std::string_view first = take_field(rest);
    if (first.empty() || first.front() == '#') continue;
    const auto fields = split_at_commas(*line);
    const auto state = parse_state(fields, where);
    if (!state) return tl::make_unexpected(state.error());
    auto appended = append_pose(read.trajectory, state->stamp, state->T_map_base, fields[0], where);
    if (!appended) return tl::make_unexpected(appended.error());
    if (state->z_m != 0) ++num_raised;
    if (fields.size() == kNumGroundTruthFields) ++num_states;
  }
  if (num_raised > 0) read.notes.push_back(fmt::format("{} heights left out", num_raised));
  if (num_states > 0) {
    read.notes.push_back(fmt::format("{} velocities with their biases left out", num_states));
  }
  if (auto good = check_stamp_unit(read.trajectory, name, "nanoseconds"); !good) {
    return tl::make_unexpected(good.error());
  }
  return read;
}

std::string euroc_text(const Trajectory& trajectory) {
  std::string text = kHead;
  for (const TrajectoryPose& pose : trajectory.poses()) {
    const double half_rad = 0.5 * pose.T_map_base.theta_rad();
    text += fmt::format("{},{},{},0,{},0,0,{}\n", pose.stamp.nanoseconds, pose.T_map_base.x_m(),
                        pose.T_map_base.y_m(), std::cos(half_rad), std::sin(half_rad));
  }
  return text;
}

}  // namespace corridor::formats
