// KITTI odometry benchmark: a pose a line, the rows of [R t]; times.txt holds the stamps.
#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <utility>

#include "datasets/formats/text.hpp"
#include "datasets/formats/trajectories/trajectory_rules.hpp"
#include "datasets/formats/trajectories/trajectory_texts.hpp"

namespace corridor::formats {
namespace {

constexpr std::size_t kNumFields = 12;
// Published files have six digits; more is not a rotation.
constexpr double kMaxOrthogonalityError = 1e-3;
// Largest sine of an angle between the pose's z axis and the map's.
constexpr double kMaxTilt = 1e-6;

struct Line {
  std::string_view text;
  std::string where;
};

// The next line that says something; nullopt at the end.
std::optional<Line> next_line(std::string_view& text, std::size_t& line_number,
                              const std::string& name) {
  while (const auto line = take_line(text)) {
    ++line_number;
    std::string_view rest = *line;
    const std::string_view first = take_field(rest);
    if (first.empty() || first.front() == '#') continue;
    return Line{*line, fmt::format("{}:{}", name, line_number)};
  }
  return std::nullopt;
}

struct SpatialPose {
  Pose2 T_map_base;
  double z_m = 0;
};

Result<SpatialPose> parse_matrix(const Line& line) {
  const auto fields = split_fields(line.text);
  if (fields.size() != kNumFields) {
    return fail(ErrorCode::kMalformed, fmt::format("{} fields", fields.size()), line.where,
                "12: the rows of [R t]");
  }
  std::array<double, kNumFields> numbers{};
  if (auto good = parse_finite(fields, line.where, numbers); !good) {
    return tl::make_unexpected(good.error());
  }
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> T(numbers.data());
  const Eigen::Matrix3d R = T.leftCols<3>();
  const double error = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(error <= kMaxOrthogonalityError) || R.determinant() < 0) {
    return fail(ErrorCode::kInvalid, "the left 3x3 block is no rotation", line.where,
                "orthogonal rows, determinant 1");
  }
  if (std::hypot(R(0, 2), R(1, 2)) > kMaxTilt || R(2, 2) < 0) {
    return fail(ErrorCode::kUnsupported, "roll or pitch", line.where,
                "a planar pose, z up (KITTI's own files have y down)");
  }
  return SpatialPose{Pose2(T(0, 3), T(1, 3), std::atan2(R(1, 0), R(0, 0))), T(2, 3)};
}

Result<Timestamp> parse_time(const Line& line) {
  const auto fields = split_fields(line.text);
  if (fields.size() != 1) {
    return fail(ErrorCode::kMalformed, fmt::format("{} fields", fields.size()), line.where,
                "1: a stamp");
  }
  const auto stamp = parse_stamp(fields[0]);
  if (!stamp) {
    return fail(ErrorCode::kMalformed, "stamp " + quote(fields[0]), line.where, "decimal seconds");
  }
  return *stamp;
}

}  // namespace

Result<ReadTrajectory> parse_kitti(std::string_view poses, const std::string& name,
                                   std::string_view times, const std::string& times_name) {
  ReadTrajectory read;
  for (const std::string_view text : {poses, times}) {
    if (auto note = note_on_end(text)) read.notes.push_back(std::move(*note));
  }
  std::size_t pose_line = 0;
  std::size_t time_line = 0;
  std::size_t num_raised = 0;
  for (;;) {
    const auto pose_text = next_line(poses, pose_line, name);
    const auto time_text = next_line(times, time_line, times_name);
    if (!pose_text && !time_text) break;
    if (!pose_text || !time_text) {
      return fail(ErrorCode::kInvalid,
                  fmt::format("{} more than {} in {}", pose_text ? "a pose" : "a stamp",
                              read.trajectory.size(), pose_text ? times_name : name),
                  pose_text ? pose_text->where : time_text->where, "one stamp per pose");
    }
    const auto pose = parse_matrix(*pose_text);
    if (!pose) return tl::make_unexpected(pose.error());
    const auto stamp = parse_time(*time_text);
    if (!stamp) return tl::make_unexpected(stamp.error());
    auto appended =
        append_pose(read.trajectory, *stamp, pose->T_map_base, time_text->text, time_text->where);
    if (!appended) return tl::make_unexpected(appended.error());
    if (pose->z_m != 0) ++num_raised;
  }
  if (num_raised > 0) read.notes.push_back(fmt::format("{} heights left out", num_raised));
  if (auto good = check_stamp_unit(read.trajectory, times_name, "seconds"); !good) {
    return tl::make_unexpected(good.error());
  }
  return read;
}

std::string kitti_text(const Trajectory& trajectory) {
  std::string text;
  for (const TrajectoryPose& pose : trajectory.poses()) {
    const double c = std::cos(pose.T_map_base.theta_rad());
    const double s = std::sin(pose.T_map_base.theta_rad());
    text += fmt::format("{} {} 0 {} {} {} 0 {} 0 0 1 0\n", c, -s, pose.T_map_base.x_m(), s, c,
                        pose.T_map_base.y_m());
  }
  return text;
}

std::string times_text(const Trajectory& trajectory) {
  std::string text;
  for (const TrajectoryPose& pose : trajectory.poses()) text += format_stamp(pose.stamp) + '\n';
  return text;
}

}  // namespace corridor::formats
