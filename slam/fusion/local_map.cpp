#include "slam/fusion/local_map.hpp"

#include "slam/core/expect.hpp"

namespace corridor::fusion {
namespace {

// Key scans and frames of submaps are poses of one graph: the frames have numbers from here on.
constexpr std::uint32_t kFirstFrame = 1U << 20U;

}  // namespace

Submap* LocalMap::insert(std::uint32_t key, const graph::Values& estimate,
                         std::span<const Eigen::Vector2d> points_base_m) {
  CORRIDOR_EXPECT(key < kFirstFrame);
  Submap* started = nullptr;
  const int full = params_.use_submaps ? params_.submap_key_scans : 1;
  if (submaps_.empty() || submaps_.back()->num_scans() >= (full + 1) / 2) {
    const auto number = static_cast<std::uint32_t>(submaps_.size());
    submaps_.push_back(
        std::make_unique<Submap>(params_.use_submaps ? kFirstFrame + number : key, params_));
    started = submaps_.back().get();
  }
  const Pose2& T_map_base = estimate.pose(key);
  for (std::size_t i = active_; i < submaps_.size(); ++i) {
    Submap& submap = *submaps_[i];
    if (submap.num_scans() >= full) continue;
    const Pose2 T_submap_base =
        &submap == started ? Pose2() : estimate.pose(submap.frame()).between(T_map_base);
    submap.insert(key, T_submap_base, points_base_m);
  }
  while (active_ + 1 < submaps_.size() && submaps_[active_]->num_scans() >= full) ++active_;
  return started;
}

void LocalMap::release(std::size_t num) {
  CORRIDOR_EXPECT(num <= active_);
  for (; num_released_ < num; ++num_released_) submaps_[num_released_].reset();
}

}  // namespace corridor::fusion
