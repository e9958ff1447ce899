// A rigid piece of the map: the surfels of some consecutive key scans. Its frame is a pose of its
// own in the graph, which begins where the first of them was: that scan has noise like any other,
// and what the others know of it is to correct it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "slam/fusion/fusion_params.hpp"
#include "slam/graph/factor_graph.hpp"
#include "slam/graph/factors/pose_factors.hpp"
#include "slam/matching/surfel_grid.hpp"

namespace corridor::fusion {

struct SubmapScan {
  std::uint32_t key = 0;
  Pose2 T_submap_base;                    // where it was inserted
  std::optional<graph::FactorId> factor;  // in the graph: its place in this submap,
  int num_observable = 0;                 // and how many directions of it that says
};

// The factor that says so: key scan `key` at T_submap_base of the submap whose frame is the pose
// `frame`; information 3x3, base, order (x_m, y_m, theta_rad), possibly singular.
graph::RelativePose place_factor(std::uint32_t frame, std::uint32_t key, const Pose2& T_submap_base,
                                 const Eigen::Matrix3d& information);

class Submap {
 public:
  // frame: number of the pose in the graph that is T_map_submap.
  Submap(std::uint32_t frame, const FusionParams& params);

  [[nodiscard]] std::uint32_t frame() const { return frame_; }
  [[nodiscard]] int num_scans() const { return static_cast<int>(scans_.size()); }
  [[nodiscard]] std::uint32_t last_key() const { return scans_.back().key; }
  [[nodiscard]] const std::vector<SubmapScan>& scans() const { return scans_; }
  // Requires that the key scan was inserted.
  void set_factor(std::uint32_t key, graph::FactorId factor, int num_observable);

  void insert(std::uint32_t key, const Pose2& T_submap_base,
              std::span<const Eigen::Vector2d> points_base_m);

  // Refine from a prior; information as in matching::match_scan. Near: on the fine surfels alone,
  // for a prior within a few of their cells. The other one may leave a good prior for another
  // basin of the coarse surfels.
  matching::MatchResult match_near(std::span<const Eigen::Vector2d> points_base_m,
                                   const Pose2& T_submap_base_prior,
                                   const Eigen::Matrix3d& prior_information, double range_sigma_m);
  matching::MatchResult match(std::span<const Eigen::Vector2d> points_base_m,
                              const Pose2& T_submap_base_prior,
                              const Eigen::Matrix3d& prior_information, double range_sigma_m);
  // Searches a window around the centre and refines what it finds.
  matching::MatchResult search(std::span<const Eigen::Vector2d> points_base_m,
                               const Pose2& T_submap_base_centre, double window_m,
                               double window_rad, const Eigen::Matrix3d& prior_information,
                               double range_sigma_m);

 private:
  std::uint32_t frame_;
  const FusionParams& params_;
  matching::SurfelGrid fine_, coarse_;
  std::vector<SubmapScan> scans_;
  std::optional<matching::SurfaceImage> image_;  // of the scans so far; made at need
};

}  // namespace corridor::fusion
