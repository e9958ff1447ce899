#include "slam/fusion/local_map.hpp"

namespace corridor::fusion {

void LocalMap::insert(std::uint32_t key, const graph::Values& estimate,
                      std::span<const Eigen::Vector2d> points_base_m) {
  const int full = params_.use_submaps ? params_.submap_key_scans : 1;
  if (submaps_.empty() || submaps_.back()->num_scans() >= (full + 1) / 2) {
    submaps_.push_back(std::make_unique<Submap>(key, params_));
  }
  const Pose2& T_map_base = estimate.pose(key);
  for (std::size_t i = active_; i < submaps_.size(); ++i) {
    Submap& submap = *submaps_[i];
    if (submap.num_scans() >= full) continue;
    submap.insert(key, estimate.pose(submap.origin_key()).between(T_map_base), points_base_m);
  }
  while (active_ + 1 < submaps_.size() && submaps_[active_]->num_scans() >= full) {
    ++active_;
    // Without loop closing nobody looks at it again.
    if (!params_.use_loop_closing) submaps_[active_ - 1].reset();
  }
}

}  // namespace corridor::fusion
