// The submaps of a run: two overlapping ones grow, the older of them is matched against, the
// finished ones wait for loop closures.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "slam/fusion/submap.hpp"
#include "slam/graph/values.hpp"

namespace corridor::fusion {

class LocalMap {
 public:
  explicit LocalMap(const FusionParams& params) : params_(params) {}

  // Adds a key scan at its estimated pose to the growing submaps, starts and finishes them. Returns
  // the submap that it started, whose frame is not in the estimate yet, or nullptr.
  Submap* insert(std::uint32_t key, const graph::Values& estimate,
                 std::span<const Eigen::Vector2d> points_base_m);
  // The submap new scans are matched against. Requires one insert().
  [[nodiscard]] Submap& active() { return *submaps_[active_]; }
  [[nodiscard]] const Submap& active() const { return *submaps_[active_]; }
  // Finished ones, oldest first; nullptr where released.
  [[nodiscard]] std::span<const std::unique_ptr<Submap>> finished() const {
    return {submaps_.data(), active_};
  }
  // Gives up the first `num` of the finished ones, which nobody will look at again.
  void release(std::size_t num);
  [[nodiscard]] std::size_t num_submaps() const { return submaps_.size(); }

 private:
  const FusionParams& params_;
  std::vector<std::unique_ptr<Submap>> submaps_;
  std::size_t active_ = 0;
  std::size_t num_released_ = 0;
};

}  // namespace corridor::fusion
