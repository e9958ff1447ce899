#include "slam/fusion/submap.hpp"

#include <algorithm>
#include <array>

#include "slam/core/expect.hpp"

namespace corridor::fusion {

using matching::MatchResult;

graph::RelativePose place_factor(std::uint32_t frame, std::uint32_t key, const Pose2& T_submap_base,
                                 const Eigen::Matrix3d& information) {
  return graph::RelativePose(graph::pose_key(frame), graph::pose_key(key), T_submap_base,
                             graph::square_root_information(information));
}

Submap::Submap(std::uint32_t frame, const FusionParams& params)
    : frame_(frame),
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
  scans_.push_back({key, T_submap_base, std::nullopt});
  image_.reset();
}

void Submap::set_factor(std::uint32_t key, graph::FactorId factor, int num_observable) {
  const auto found = std::find_if(scans_.rbegin(), scans_.rend(),
                                  [&](const SubmapScan& scan) { return scan.key == key; });
  CORRIDOR_EXPECT(found != scans_.rend());
  found->factor = factor;
  found->num_observable = num_observable;
}

MatchResult Submap::match_near(std::span<const Eigen::Vector2d> points_base_m,
                               const Pose2& T_submap_base_prior,
                               const Eigen::Matrix3d& prior_information, double range_sigma_m) {
  const std::array<matching::SurfelGrid*, 1> levels = {&fine_};
  return matching::match_scan(levels, points_base_m, T_submap_base_prior, prior_information,
                              range_sigma_m, params_.matcher);
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
  return match_near(points_base_m, found.T_map_base, prior_information, range_sigma_m);
}

}  // namespace corridor::fusion
