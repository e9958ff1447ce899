#include "bench/metrics/alignment.hpp"

#include <Eigen/Core>
#include <cmath>

namespace corridor::metrics {
namespace {

// Below this ratio of correlation to spread the best rotation is noise.
constexpr double kMinCorrelationRatio = 1e-9;
// Positions that all lie within this of their mean are one position.
constexpr double kMinSpread_m = 1e-9;

// [Umeyama1991] eq. 40-42 in the plane: the sum of the products of the centred positions has the
// angle of the best rotation as that of a complex number.
std::optional<Pose2> align_least_squares(std::span<const MatchedPose> pairs) {
  const auto n = static_cast<double>(pairs.size());
  Eigen::Vector2d mean_map = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_world = Eigen::Vector2d::Zero();
  for (const MatchedPose& pair : pairs) {
    mean_map += pair.T_map_base.translation_m() / n;
    mean_world += pair.T_world_base.translation_m() / n;
  }
  double cosine_m2 = 0, sine_m2 = 0, spread_map_m2 = 0, spread_world_m2 = 0;
  for (const MatchedPose& pair : pairs) {
    const Eigen::Vector2d map_m = pair.T_map_base.translation_m() - mean_map;
    const Eigen::Vector2d world_m = pair.T_world_base.translation_m() - mean_world;
    cosine_m2 += map_m.dot(world_m);
    sine_m2 += map_m.x() * world_m.y() - map_m.y() * world_m.x();
    spread_map_m2 += map_m.squaredNorm();
    spread_world_m2 += world_m.squaredNorm();
  }
  const double spread_m2 = std::sqrt(spread_map_m2) * std::sqrt(spread_world_m2);
  const bool is_determined = std::hypot(cosine_m2, sine_m2) > kMinCorrelationRatio * spread_m2 &&
                             spread_m2 > n * kMinSpread_m * kMinSpread_m;
  if (!is_determined) return std::nullopt;
  const Pose2 rotation(0, 0, std::atan2(sine_m2, cosine_m2));
  const Eigen::Vector2d translation_m = mean_world - rotation * mean_map;
  return Pose2(translation_m.x(), translation_m.y(), rotation.theta_rad());
}

}  // namespace

std::string_view to_text(Alignment alignment) {
  switch (alignment) {
    case Alignment::kOrigin:
      return "origin";
    case Alignment::kSe2:
      return "se2";
    case Alignment::kNone:
      return "none";
  }
  return "";
}

std::optional<Alignment> alignment_from_text(std::string_view text) {
  for (const auto alignment : {Alignment::kOrigin, Alignment::kSe2, Alignment::kNone}) {
    if (text == to_text(alignment)) return alignment;
  }
  return std::nullopt;
}

std::optional<Pose2> align(std::span<const MatchedPose> pairs, Alignment alignment) {
  if (pairs.empty()) return std::nullopt;
  switch (alignment) {
    case Alignment::kOrigin:
      return pairs[0].T_world_base * pairs[0].T_map_base.inverse();
    case Alignment::kSe2:
      return align_least_squares(pairs);
    case Alignment::kNone:
      return Pose2();
  }
  return std::nullopt;
}

}  // namespace corridor::metrics
