// A rigid piece of the map: the surfels of some consecutive key scans in the frame of the first.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "slam/fusion/fusion_params.hpp"
#include "slam/matching/surfel_grid.hpp"

namespace corridor::fusion {

class Submap {
 public:
  Submap(std::uint32_t origin_key, const FusionParams& params);

  // The key frame whose pose is this submap's frame.
  [[nodiscard]] std::uint32_t origin_key() const { return origin_key_; }
  [[nodiscard]] int num_scans() const { return static_cast<int>(scan_poses_.size()); }
  [[nodiscard]] std::uint32_t last_key() const { return last_key_; }
  // T_submap_base of the inserted scans.
  [[nodiscard]] const std::vector<Pose2>& scan_poses() const { return scan_poses_; }

  void insert(std::uint32_t key, const Pose2& T_submap_base,
              std::span<const Eigen::Vector2d> points_base_m);

  // Refines from a prior; information as in matching::match_scan.
  matching::MatchResult match(std::span<const Eigen::Vector2d> points_base_m,
                              const Pose2& T_submap_base_prior,
                              const Eigen::Matrix3d& prior_information, double range_sigma_m);
  // Searches a window around the centre and refines what it finds.
  matching::MatchResult search(std::span<const Eigen::Vector2d> points_base_m,
                               const Pose2& T_submap_base_centre, double window_m,
                               double window_rad, const Eigen::Matrix3d& prior_information,
                               double range_sigma_m);

 private:
  std::uint32_t origin_key_;
  std::uint32_t last_key_;
  const FusionParams& params_;
  matching::SurfelGrid fine_, coarse_;
  std::vector<Pose2> scan_poses_;
  std::optional<matching::SurfaceImage> image_;  // of the scans so far; made at need
};

}  // namespace corridor::fusion
