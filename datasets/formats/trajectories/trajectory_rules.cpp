#include "datasets/formats/trajectories/trajectory_rules.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "datasets/formats/median.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

// Files with six decimals have quaternions this far from unit length; more is not a rotation.
constexpr double kMaxNormError = 1e-3;
// sin of half of the largest roll or pitch that still counts as planar.
constexpr double kMaxTilt = 0.5e-6;
// Fewer poses may be far apart on purpose.
constexpr std::size_t kMinPosesForMedian = 5;
constexpr double kMinMedianStep_s = 1e-6;
constexpr double kMaxMedianStep_s = 10.0;

}  // namespace

Result<void> parse_finite(std::span<const std::string_view> fields, const std::string& where,
                          std::span<double> numbers) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto number = parse_double(fields[i]);
    if (!number || !std::isfinite(*number)) {
      return fail(ErrorCode::kMalformed, "field " + quote(fields[i]), where, "a finite number");
    }
    numbers[i] = *number;
  }
  return {};
}

Result<double> yaw_of_quaternion(double qx, double qy, double qz, double qw,
                                 const std::string& where) {
  const double norm = std::sqrt(qx * qx + qy * qy + qz * qz + qw * qw);
  if (!(std::abs(norm - 1) <= kMaxNormError)) {
    return fail(ErrorCode::kInvalid, fmt::format("quaternion of length {:.6g}", norm), where, "1");
  }
  if (std::hypot(qx, qy) > kMaxTilt) {
    return fail(ErrorCode::kUnsupported, fmt::format("roll or pitch (qx = {}, qy = {})", qx, qy),
                where, "a planar pose, qx = qy = 0");
  }
  return 2 * std::atan2(qz, qw);
}

Result<void> append_pose(Trajectory& trajectory, Timestamp stamp, const Pose2& T_map_base,
                         std::string_view stamp_text, const std::string& where) {
  if (trajectory.append({stamp, T_map_base, std::nullopt})) return {};
  return fail(ErrorCode::kInvalid, "stamp " + quote(stamp_text) + " is not later than the last",
              where, "stamps that increase");
}

Result<void> check_stamp_unit(const Trajectory& trajectory, const std::string& name,
                              std::string_view unit) {
  if (trajectory.size() < kMinPosesForMedian) return {};
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    steps_s.push_back(seconds_between(trajectory[i - 1].stamp, trajectory[i].stamp));
  }
  const double median_s = upper_median(std::move(steps_s));
  if (median_s >= kMinMedianStep_s && median_s <= kMaxMedianStep_s) return {};
  return fail(ErrorCode::kInvalid, fmt::format("median step between stamps is {:.6g} s", median_s),
              name,
              fmt::format("stamps in {}: steps of {:g} s to {:g} s", unit, kMinMedianStep_s,
                          kMaxMedianStep_s));
}

}  // namespace corridor::formats
