#include "datasets/formats/tum.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "datasets/formats/atomic_file.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

constexpr std::size_t kNumFields = 8;
// Files with six decimals have quaternions this far from unit length; more is not a rotation.
constexpr double kMaxNormError = 1e-3;
// sin of half of the largest roll or pitch that still counts as planar.
constexpr double kMaxTilt = 0.5e-6;
constexpr const char* kLayout = "'stamp x y z qx qy qz qw'";

struct PlanarPose {
  Timestamp stamp;
  Pose2 T_map_base;
};

Result<PlanarPose> parse_pose(std::string_view line, const std::string& where) {
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
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = parse_double(fields[i + 1]);
    if (!number || !std::isfinite(*number)) {
      return fail(ErrorCode::kMalformed, "field " + quote(fields[i + 1]), where, "a finite number");
    }
    numbers[i] = *number;
  }
  const auto [x_m, y_m, z_m, qx, qy, qz, qw] = numbers;
  const double norm = std::sqrt(qx * qx + qy * qy + qz * qz + qw * qw);
  if (std::abs(norm - 1) > kMaxNormError) {
    return fail(ErrorCode::kInvalid, fmt::format("quaternion of length {:.6g}", norm), where, "1");
  }
  if (std::hypot(qx, qy) > kMaxTilt) {
    return fail(ErrorCode::kUnsupported, fmt::format("roll or pitch (qx = {}, qy = {})", qx, qy),
                where, "a planar pose, qx = qy = 0");
  }
  return PlanarPose{*stamp, Pose2(x_m, y_m, 2 * std::atan2(qz, qw))};
}

}  // namespace

Result<Trajectory> parse_tum(std::string_view text, const std::string& name) {
  Trajectory trajectory;
  std::size_t line_number = 0;
  while (const auto line = take_line(text)) {
    const std::string where = fmt::format("{}:{}", name, ++line_number);
    std::string_view rest = *line;
    const std::string_view first = take_field(rest);
    if (first.empty() || first.front() == '#') continue;
    const auto pose = parse_pose(*line, where);
    if (!pose) return tl::make_unexpected(pose.error());
    if (!trajectory.append({pose->stamp, pose->T_map_base, std::nullopt})) {
      return fail(ErrorCode::kInvalid, "stamp " + quote(first) + " is not later than the last",
                  where, "stamps that increase");
    }
  }
  return trajectory;
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
