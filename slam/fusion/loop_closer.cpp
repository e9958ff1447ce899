#include "slam/fusion/loop_closer.hpp"

#include <algorithm>
#include <cmath>

#include "slam/backend/robust/maximum_clique.hpp"
#include "slam/fusion/scan_tracker.hpp"

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
  return estimate.pose(closure.submap_frame) * closure.match.T_map_base;
}

// Both say where the robot was in the map; odometry between them must say the same.
bool agree(const LoopClosure& a, const LoopClosure& b, const graph::Values& estimate,
           const FusionParams& params) {
  const Pose2 by_odometry = estimate.pose(a.scan_key).between(estimate.pose(b.scan_key));
  const Pose2 by_closures = closed_pose(a, estimate).between(closed_pose(b, estimate));
  const Pose2 difference = by_odometry.between(by_closures);
  const double path_m = std::abs(b.path_m - a.path_m);
  return difference.translation_m().norm() <=
             params.loop_agreement_m + params.loop_drift_ratio * path_m &&
         std::abs(difference.theta_rad()) <=
             params.loop_agreement_rad + kHeadingDrift_radpm * path_m;
}

// Times what a set needs, to be firm.
constexpr int kFirmAgreeing = 2;
constexpr double kFirmSpan = 3;
// Of the search for a largest set of some ten closures.
constexpr std::int64_t kMaxBranches = 10000;

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
    if (now.path_m - key_scans[submap->last_key()].path_m < params_.loop_min_path_m) continue;
    const Pose2& T_map_submap = estimate.pose(submap->frame());
    for (const SubmapScan& scan : submap->scans()) {
      const double distance_m = (T_map_submap * scan.T_submap_base.translation_m() - here).norm();
      if (distance_m < nearest_m) {
        nearest_m = distance_m;
        nearest = submap.get();
      }
    }
  }
  return nearest;
}

std::optional<LoopClosure> LoopCloser::match_here(const KeyScan& key_scan, std::uint32_t key,
                                                  Submap& submap,
                                                  const graph::Values& estimate) const {
  const Pose2 T_submap_base = estimate.pose(submap.frame()).between(estimate.pose(key));
  auto match = match_again(submap, key_scan.points_base_m, T_submap_base, robot_, params_);
  if (!match || match->num_observable == 0) return std::nullopt;
  const Pose2 shift = T_submap_base.between(match->T_map_base);
  if (shift.translation_m().norm() > params_.loop_agreement_m ||
      std::abs(shift.theta_rad()) > params_.loop_agreement_rad) {
    return std::nullopt;
  }
  return LoopClosure{submap.frame(), key, std::move(*match), key_scan.path_m};
}

std::optional<LoopClosure> LoopCloser::match_in_window(const KeyScan& key_scan, std::uint32_t key,
                                                       Submap& submap,
                                                       const graph::Values& estimate) const {
  const Pose2 T_submap_base = estimate.pose(submap.frame()).between(estimate.pose(key));
  const double path_m = key_scan.path_m - last_closure_path_m_;
  const double window_m =
      std::clamp(params_.loop_drift_ratio * path_m, kMinWindow_m, params_.loop_max_window_m);
  const double window_rad =
      std::clamp(kHeadingDrift_radpm * path_m, kMinWindow_rad, params_.loop_max_window_rad);
  const matching::MatchResult result =
      submap.search(key_scan.points_base_m, T_submap_base, window_m, window_rad,
                    Eigen::Matrix3d::Zero(), robot_.lidar.range_sigma_m);
  if (!result.is_usable() || result.inlier_ratio < params_.loop_min_inlier_ratio) {
    return std::nullopt;
  }
  LoopClosure closure{submap.frame(), key, matching::observable_part(result, params_.observability),
                      key_scan.path_m};
  const Pose2 shift = T_submap_base.between(closure.match.T_map_base);
  const bool is_inside = shift.translation_m().norm() <= kRefinedWindow * window_m &&
                         std::abs(shift.theta_rad()) <= kRefinedWindow * window_rad;
  // Along a direction that it does not see a search is free to go anywhere.
  if (!is_inside || closure.match.num_observable < 3) return std::nullopt;
  return closure;
}

std::vector<LoopClosure> LoopCloser::agreeing(const graph::Values& estimate) const {
  backend::BitGraph pairs(pending_.size());
  for (std::size_t a = 0; a < pending_.size(); ++a) {
    for (std::size_t b = a + 1; b < pending_.size(); ++b) {
      if (agree(pending_[a], pending_[b], estimate, params_)) pairs.join(a, b);
    }
  }
  const backend::Clique clique = backend::maximum_clique(pairs, kMaxBranches);
  std::vector<LoopClosure> closures;
  for (const std::size_t node : clique.nodes) closures.push_back(pending_[node]);
  if (closures.empty()) return {};
  const auto num_agreeing = static_cast<int>(closures.size());
  const double span_m = closures.back().path_m - closures.front().path_m;
  if (num_agreeing < params_.loop_min_agreeing || span_m < params_.loop_min_span_m) return {};
  const bool is_firm = num_agreeing >= kFirmAgreeing * params_.loop_min_agreeing &&
                       span_m >= kFirmSpan * params_.loop_min_span_m;
  // What odometry has refuted it would refute again, until it is firm.
  if (was_refuted_ && !is_firm) return {};
  for (LoopClosure& closure : closures) closure.is_firm = is_firm;
  return closures;
}

std::vector<LoopClosure> LoopCloser::search(std::span<const KeyScan> key_scans, LocalMap& local_map,
                                            const graph::Values& estimate) {
  const KeyScan& now = key_scans.back();
  const auto key = static_cast<std::uint32_t>(key_scans.size() - 1);
  const bool is_linked =
      last_closure_path_m_ > 0 && now.path_m - last_closure_path_m_ <= params_.loop_link_m;
  if (!is_linked && now.path_m - last_search_path_m_ < params_.loop_interval_m) return {};
  Submap* submap = nearest_candidate(key_scans, local_map, estimate);
  if (submap == nullptr) return {};
  ++num_candidates_;
  if (is_linked) {
    auto here = match_here(now, key, *submap, estimate);
    return here ? std::vector{std::move(*here)} : std::vector<LoopClosure>{};
  }
  last_search_path_m_ = now.path_m;
  auto found = match_in_window(now, key, *submap, estimate);
  if (!found) return {};
  std::erase_if(pending_, [&](const LoopClosure& closure) {
    return now.path_m - closure.path_m > params_.loop_memory_m;
  });
  if (pending_.empty()) was_refuted_ = false;
  pending_.push_back(std::move(*found));
  return agreeing(estimate);
}

}  // namespace corridor::fusion
