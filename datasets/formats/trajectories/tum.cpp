#include "datasets/formats/trajectories/tum.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/text.hpp"
#include "datasets/formats/trajectories/trajectory_rules.hpp"
#include "datasets/formats/trajectories/trajectory_texts.hpp"

namespace corridor::formats {
namespace {

constexpr std::size_t kNumFields = 8;
constexpr const char* kLayout = "'stamp x y z qx qy qz qw'";

struct SpatialPose {
  Timestamp stamp;
  Pose2 T_map_base;
  double z_m = 0;
};

Result<SpatialPose> parse_pose(std::string_view line, const std::string& where) {
  const auto fields = split_fields(line);
  if (fields.size() != kNumFields) {
    return fail(ErrorCode::kMalformed, fmt::format("{} fields", fields.size()), where,
                fmt::format("8: {}", kLayout));
  }
  const auto stamp = parse_stamp(fields[0]);
  if (!stamp) {
    return fail(ErrorCode::kMalformed, "stamp " + quote(fields[0]), where, "decimal seconds");
  }
  std::array<double, kNumFields - 1> numbers{};
  if (auto good = parse_finite(std::span(fields).subspan(1), where, numbers); !good) {
    return tl::make_unexpected(good.error());
  }
  const auto [x_m, y_m, z_m, qx, qy, qz, qw] = numbers;
  const auto yaw_rad = yaw_of_quaternion(qx, qy, qz, qw, where);
  if (!yaw_rad) return tl::make_unexpected(yaw_rad.error());
  return SpatialPose{*stamp, Pose2(x_m, y_m, *yaw_rad), z_m};
}

}  // namespace

Result<ReadTrajectory> parse_tum_trajectory(std::string_view text, const std::string& name) {
  ReadTrajectory read;
  if (auto note = note_on_end(text)) read.notes.push_back(std::move(*note));
  std::size_t num_raised = 0;
  std::size_t line_number = 0;
  while (const auto line = take_line(text)) {
    const std::string where = fmt::format("{}:{}", name, ++line_number);
    std::string_view rest = *line;
    const std::string_view first = take_field(rest);
    if (first.empty() || first.front() == '#') continue;
    const auto pose = parse_pose(*line, where);
    if (!pose) return tl::make_unexpected(pose.error());
    auto appended = append_pose(read.trajectory, pose->stamp, pose->T_map_base, first, where);
    if (!appended) return tl::make_unexpected(appended.error());
    if (pose->z_m != 0) ++num_raised;
  }
  if (num_raised > 0) read.notes.push_back(fmt::format("{} heights left out", num_raised));
  if (auto good = check_stamp_unit(read.trajectory, name, "seconds"); !good) {
    return tl::make_unexpected(good.error());
  }
  return read;
}

Result<Trajectory> parse_tum(std::string_view text, const std::string& name) {
  auto read = parse_tum_trajectory(text, name);
  if (!read) return tl::make_unexpected(read.error());
  return std::move(read->trajectory);
}

Result<Trajectory> read_tum(const std::filesystem::path& path) {
  const auto bytes = read_file_bytes(path);
  if (!bytes) return tl::make_unexpected(bytes.error());
  return parse_tum(*bytes, path.string());
}

std::string tum_text(const Trajectory& trajectory) {
  std::string text;
  for (const TrajectoryPose& pose : trajectory.poses()) {
    const double half_rad = 0.5 * pose.T_map_base.theta_rad();
    text += fmt::format("{} {} {} 0 0 0 {} {}\n", format_stamp(pose.stamp), pose.T_map_base.x_m(),
                        pose.T_map_base.y_m(), std::sin(half_rad), std::cos(half_rad));
  }
  return text;
}

Result<void> write_tum(const Trajectory& trajectory, const std::filesystem::path& path) {
  return write_file_atomically(path, tum_text(trajectory));
}

}  // namespace corridor::formats
