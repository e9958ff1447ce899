#include "slam/fusion/submap.hpp"

#include <array>

namespace corridor::fusion {

using matching::MatchResult;

Submap::Submap(std::uint32_t origin_key, const FusionParams& params)
    : origin_key_(origin_key),
      last_key_(origin_key),
      params_(params),
      fine_(params.fine_resolution_m),
      coarse_(params.coarse_resolution_m) {}

void Submap::insert(std::uint32_t key, const Pose2& T_submap_base,
                    std::span<const Eigen::Vector2d> points_base_m) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(points_base_m.size());
  const Eigen::Matrix2d R = T_submap_base.rotation();
  for (const Eigen::Vector2d& p : points_base_m) {
    points.emplace_back(R * p + T_submap_base.translation_m());
  }
  fine_.insert(points);
  coarse_.insert(points);
  scan_poses_.push_back(T_submap_base);
  last_key_ = key;
  image_.reset();
}

MatchResult Submap::match(std::span<const Eigen::Vector2d> points_base_m,
                          const Pose2& T_submap_base_prior,
                          const Eigen::Matrix3d& prior_information, double range_sigma_m) {
  const std::array<matching::SurfelGrid*, 2> levels = {&coarse_, &fine_};
  return matching::match_scan(levels, points_base_m, T_submap_base_prior, prior_information,
                              range_sigma_m, params_.matcher);
}

MatchResult Submap::search(std::span<const Eigen::Vector2d> points_base_m,
                           const Pose2& T_submap_base_centre, double window_m, double window_rad,
                           const Eigen::Matrix3d& prior_information, double range_sigma_m) {
  if (!image_) image_.emplace(fine_.cell_means_m(), params_.correlative);
  const matching::CorrelativeResult found = matching::search(
      *image_, points_base_m, T_submap_base_centre, window_m, window_rad, params_.correlative);
  return match(points_base_m, found.T_map_base, prior_information, range_sigma_m);
}

}  // namespace corridor::fusion
