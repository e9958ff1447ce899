// Registers the points of a scan to a surfel map by Gauss-Newton on robust point-to-line distances,
// with a prior on the pose: minimises sum_i rho(n_i^T (T p_i - mu_i) / s_i) + |T (-) T_prior|^2_P.
// Point-to-line on straight walls pulls nothing along them, so that a range-limited scan of a
// corridor is not drawn back to where its walls were seen to end. [Censi2008], [Biber2003].
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "slam/core/params.hpp"
#include "slam/core/pose2.hpp"
#include "slam/matching/surfel_grid.hpp"

namespace corridor::matching {

struct MatcherParams {
  int max_iterations = 20;
  double min_step_m = 1e-4;       // stop below; an angle counts as an arc of 1 m
  double surface_sigma_m = 0.02;  // roughness and map error of a surface, beside the range noise
  double robust_scale = 2.0;      // Cauchy kernel, in standard deviations
  double inlier_sigmas = 3.0;     // a point this near to its surface counts as explained
  double min_inlier_ratio = 0.4;  // fewer explained: no match

  template <class V>
  static void visit(MatcherParams& p, V&& v) {
    v(ParamInfo{"max_iterations", "1", "Gauss-Newton steps per level", 1, 200}, p.max_iterations);
    v(ParamInfo{"min_step_m", "m", "stop when a step is shorter", 0, 0.1}, p.min_step_m);
    v(ParamInfo{"surface_sigma_m", "m", "roughness of surfaces and error of the map", 0, 1},
      p.surface_sigma_m);
    v(ParamInfo{"robust_scale", "1", "Cauchy kernel's scale in standard deviations", 0.1, 100},
      p.robust_scale);
    v(ParamInfo{"inlier_sigmas", "1", "distance at which a point counts as explained", 0.5, 20},
      p.inlier_sigmas);
    v(ParamInfo{"min_inlier_ratio", "1", "smallest share of explained points of a match", 0, 1},
      p.min_inlier_ratio);
  }
};

enum class MatchStatus {
  kConverged,
  kMaxIterations,  // usable, but still moving
  kNoOverlap,      // too few points lie near a known surface
  kPoorFit,        // fewer points explained than min_inlier_ratio
};

struct MatchResult {
  MatchStatus status = MatchStatus::kNoOverlap;
  Pose2 T_map_base;  // optimum of scan and prior
  // Quadratic approximation of the scan's own cost (without the prior) at T_map_base, right tangent
  // in base, order (x_m, y_m, theta_rad): cost(delta) = const + 2 gradient^T delta + delta^T
  // information delta.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  // Information along each surface that is only there because normals are noisy: what a perfectly
  // straight wall would show along itself. Same order and frame.
  Eigen::Matrix3d spurious_information = Eigen::Matrix3d::Zero();
  int num_points = 0;
  int num_matched = 0;      // points with a surface nearby
  double inlier_ratio = 0;  // explained points over all points
  int num_iterations = 0;

  [[nodiscard]] bool is_usable() const {
    return status == MatchStatus::kConverged || status == MatchStatus::kMaxIterations;
  }
};

// levels: coarse to fine; each is refined in turn, the last one gives the result. Not empty.
// prior_information: 3x3 in the base frame of T_map_base_prior; zero for none.
// range_sigma_m: standard deviation of one range.
MatchResult match_scan(std::span<SurfelGrid* const> levels,
                       std::span<const Eigen::Vector2d> points_base_m,
                       const Pose2& T_map_base_prior, const Eigen::Matrix3d& prior_information,
                       double range_sigma_m, const MatcherParams& params);

}  // namespace corridor::matching
