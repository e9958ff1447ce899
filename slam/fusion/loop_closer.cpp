#include "slam/fusion/loop_closer.hpp"

#include <algorithm>
#include <cmath>

namespace corridor::fusion {
namespace {

// The window never gets smaller than what a few metres of drift need.
constexpr double kMinWindow_m = 0.3;
constexpr double kMinWindow_rad = 0.1;
// The refinement may leave the search window by a part of it.
constexpr double kRefinedWindow = 1.5;
// Heading drift per path that widens the angular window.
constexpr double kHeadingDrift_radpm = 0.01;

Pose2 closed_pose(const LoopClosure& closure, const graph::Values& estimate) {
  return estimate.pose(closure.submap_key) * closure.match.T_map_base;
}

}  // namespace

Submap* LoopCloser::nearest_candidate(std::span<const KeyScan> key_scans, LocalMap& local_map,
                                      const graph::Values& estimate) const {
  const KeyScan& now = key_scans.back();
  const Eigen::Vector2d here =
      estimate.pose(static_cast<std::uint32_t>(key_scans.size() - 1)).translation_m();
  const double radius_m = params_.loop_radius_m +
                          std::min(params_.loop_max_window_m,
                                   params_.loop_drift_ratio * (now.path_m - last_closure_path_m_));
  Submap* nearest = nullptr;
  double nearest_m = radius_m;
  for (const auto& submap : local_map.finished()) {
    if (submap == nullptr) continue;
    if (now.path_m - key_scans[submap->last_key()].path_m < params_.loop_min_path_m) continue;
    const Pose2& T_map_submap = estimate.pose(submap->origin_key());
    for (const Pose2& T_submap_base : submap->scan_poses()) {
      const double distance_m = (T_map_submap * T_submap_base.translation_m() - here).norm();
      if (distance_m < nearest_m) {
        nearest_m = distance_m;
        nearest = submap.get();
      }
    }
  }
  return nearest;
}

std::optional<LoopClosure> LoopCloser::match(const KeyScan& key_scan, std::uint32_t key,
                                             Submap& submap, const graph::Values& estimate,
                                             double range_sigma_m) const {
  const Pose2 T_submap_base = estimate.pose(submap.origin_key()).between(estimate.pose(key));
  const double path_m = key_scan.path_m - last_closure_path_m_;
  const double window_m =
      std::clamp(params_.loop_drift_ratio * path_m, kMinWindow_m, params_.loop_max_window_m);
  const double window_rad =
      std::clamp(kHeadingDrift_radpm * path_m, kMinWindow_rad, params_.loop_max_window_rad);
  const matching::MatchResult result =
      submap.search(key_scan.points_base_m, T_submap_base, window_m, window_rad,
                    Eigen::Matrix3d::Zero(), range_sigma_m);
  if (!result.is_usable() || result.inlier_ratio < params_.loop_min_inlier_ratio) {
    return std::nullopt;
  }
  LoopClosure closure{submap.origin_key(), key,
                      matching::observable_part(result, params_.observability)};
  const Pose2 shift = T_submap_base.between(closure.match.T_map_base);
  const bool is_inside = shift.translation_m().norm() <= kRefinedWindow * window_m &&
                         std::abs(shift.theta_rad()) <= kRefinedWindow * window_rad;
  if (!is_inside || closure.match.num_observable < 2) return std::nullopt;
  return closure;
}

std::vector<LoopClosure> LoopCloser::search(std::span<const KeyScan> key_scans, LocalMap& local_map,
                                            const graph::Values& estimate, double range_sigma_m) {
  const KeyScan& now = key_scans.back();
  if (now.path_m - last_search_path_m_ < params_.loop_interval_m) return {};
  last_search_path_m_ = now.path_m;
  Submap* submap = nearest_candidate(key_scans, local_map, estimate);
  std::optional<LoopClosure> found;
  if (submap != nullptr) {
    ++num_candidates_;
    found = match(now, static_cast<std::uint32_t>(key_scans.size() - 1), *submap, estimate,
                  range_sigma_m);
  }
  std::optional<LoopClosure> before = std::exchange(pending_, found);
  if (!found || !before) return {};
  // Both say where the robot was in the map; odometry between them must say the same.
  const Pose2 by_odometry = estimate.pose(before->scan_key).between(estimate.pose(found->scan_key));
  const Pose2 by_closures = closed_pose(*before, estimate).between(closed_pose(*found, estimate));
  const Pose2 difference = by_odometry.between(by_closures);
  if (difference.translation_m().norm() > params_.loop_agreement_m ||
      std::abs(difference.theta_rad()) > params_.loop_agreement_rad) {
    return {};
  }
  return {std::move(*before), std::move(*found)};
}

}  // namespace corridor::fusion
