#include "slam/fusion/submap_refiner.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "slam/fusion/scan_tracker.hpp"

namespace corridor::fusion {
graph::NewFactor frame_factor(Submap& submap, const KeyScan& first, const RobotModel& robot,
                              const FusionParams& params) {
  const matching::ObservableMatch match =
      match_again(submap, first.points_base_m, Pose2(), robot, params)
          .value_or(matching::ObservableMatch{});
  return place_factor(submap.frame(), submap.scans().front().key, Pose2(),
                      matching::defining_information(match, params.observability));
}

void SubmapRefiner::refine(Submap& submap, std::size_t scan, std::span<const KeyScan> key_scans,
                           const graph::Values& estimate, std::vector<RefinedPlace>& places) const {
  const SubmapScan& placed = submap.scans()[scan];
  const KeyScan& key_scan = key_scans[placed.key];
  if (!key_scan.is_trusted) return;
  const Pose2 T_submap_base = estimate.pose(submap.frame()).between(estimate.pose(placed.key));
  const auto match = match_again(submap, key_scan.points_base_m, T_submap_base, robot_, params_);
  // What saw less would leave undetermined what the wheels do not hold either.
  if (!match || match->num_observable < std::max(placed.num_observable, 1)) return;
  const Eigen::Matrix3d information =
      scan == 0 ? matching::defining_information(*match, params_.observability)
                : match->information;
  places.push_back(
      {place_factor(submap.frame(), placed.key, match->T_map_base, information), placed.factor});
}

std::vector<RefinedPlace> SubmapRefiner::next(int max_scans, std::span<const KeyScan> key_scans,
                                              LocalMap& local_map, const graph::Values& estimate) {
  std::vector<RefinedPlace> places;
  for (int i = 0; i < max_scans && submap_ < local_map.finished().size(); ++i) {
    Submap& submap = *local_map.finished()[submap_];
    refine(submap, scan_, key_scans, estimate, waiting_);
    if (++scan_ < submap.scans().size()) continue;
    scan_ = 0;
    ++submap_;
    std::move(waiting_.begin(), waiting_.end(), std::back_inserter(places));
    waiting_.clear();
  }
  return places;
}

std::vector<RefinedPlace> SubmapRefiner::rest(std::span<const KeyScan> key_scans,
                                              LocalMap& local_map, const graph::Values& estimate) {
  std::vector<RefinedPlace> places =
      next(std::numeric_limits<int>::max(), key_scans, local_map, estimate);
  Submap& active = local_map.active();
  if (2 * active.num_scans() < params_.submap_key_scans) return places;
  for (std::size_t scan = 0; scan < active.scans().size(); ++scan) {
    refine(active, scan, key_scans, estimate, places);
  }
  return places;
}

}  // namespace corridor::fusion
