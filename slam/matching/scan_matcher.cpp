#include "slam/matching/scan_matcher.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "slam/core/expect.hpp"

namespace corridor::matching {
namespace {

// Points needed before three unknowns can be told from noise.
constexpr int kMinMatchedPoints = 10;

struct Linearization {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d spurious = Eigen::Matrix3d::Zero();
  int num_matched = 0;
  int num_inliers = 0;
};

// Row of d (direction^T T p) / d delta for a right perturbation of T = (R, t).
Eigen::RowVector3d row_along(const Eigen::Vector2d& direction_base, const Eigen::Vector2d& p_base) {
  return {direction_base.x(), direction_base.y(),
          direction_base.y() * p_base.x() - direction_base.x() * p_base.y()};
}

Linearization linearize(SurfelGrid& grid, std::span<const Eigen::Vector2d> points_base,
                        const Pose2& T_map_base, double range_sigma_m,
                        const MatcherParams& params) {
  Linearization sum;
  const Eigen::Matrix2d R = T_map_base.rotation();
  const Eigen::Vector2d t = T_map_base.translation_m();
  const double noise_m2 =
      params.surface_sigma_m * params.surface_sigma_m + range_sigma_m * range_sigma_m;
  const double kernel2 = params.robust_scale * params.robust_scale;
  const double inlier2 = params.inlier_sigmas * params.inlier_sigmas;
  for (const Eigen::Vector2d& p : points_base) {
    const Eigen::Vector2d point_map = R * p + t;
    const Surfel* surfel = grid.find(point_map);
    if (surfel == nullptr) continue;
    ++sum.num_matched;
    const double variance = surfel->normal_variance_m2 + noise_m2;
    const double distance = surfel->normal.dot(point_map - surfel->mean_m);
    const double e2 = distance * distance / variance;
    if (e2 < inlier2) ++sum.num_inliers;
    const double weight = 1 / (variance * (1 + e2 / kernel2));  // Cauchy
    const Eigen::Vector2d normal_base = R.transpose() * surfel->normal;
    const Eigen::RowVector3d row = row_along(normal_base, p);
    sum.information.noalias() += weight * row.transpose() * row;
    sum.gradient.noalias() += weight * distance * row.transpose();
    // Variance of the normal's angle from a line fit: sigma^2 / (n * spread along the line).
    const double angle_variance =
        variance / (surfel->num_points * std::max(surfel->tangent_variance_m2, noise_m2));
    const Eigen::RowVector3d along = row_along({-normal_base.y(), normal_base.x()}, p);
    sum.spurious.noalias() += weight * angle_variance * along.transpose() * along;
  }
  return sum;
}

double step_length_m(const Eigen::Vector3d& delta) { return delta.norm(); }

}  // namespace

MatchResult match_scan(std::span<SurfelGrid* const> levels,
                       std::span<const Eigen::Vector2d> points_base_m,
                       const Pose2& T_map_base_prior, const Eigen::Matrix3d& prior_information,
                       double range_sigma_m, const MatcherParams& params) {
  CORRIDOR_EXPECT(!levels.empty());
  MatchResult result;
  result.T_map_base = T_map_base_prior;
  result.num_points = static_cast<int>(points_base_m.size());
  if (result.num_points == 0) return result;
  // The smallest information that keeps the step defined along an unseen direction without a prior.
  const Eigen::Matrix3d regular = Eigen::Matrix3d::Identity() * 1e-3;
  for (SurfelGrid* grid : levels) {
    result.status = MatchStatus::kMaxIterations;
    for (int i = 0; i < params.max_iterations; ++i) {
      const Linearization at =
          linearize(*grid, points_base_m, result.T_map_base, range_sigma_m, params);
      result.num_matched = at.num_matched;
      if (at.num_matched < kMinMatchedPoints) {
        result.status = MatchStatus::kNoOverlap;
        break;
      }
      const Pose2::Tangent from_prior = result.T_map_base.minus(T_map_base_prior);
      const Eigen::Matrix3d H = at.information + prior_information + regular;
      const Eigen::Vector3d g = at.gradient + prior_information * from_prior;
      const Eigen::Vector3d delta = -H.ldlt().solve(g);
      result.T_map_base = result.T_map_base.plus(delta);
      ++result.num_iterations;
      if (step_length_m(delta) < params.min_step_m) {
        result.status = MatchStatus::kConverged;
        break;
      }
    }
  }
  if (result.status == MatchStatus::kNoOverlap) return result;
  const Linearization at =
      linearize(*levels.back(), points_base_m, result.T_map_base, range_sigma_m, params);
  result.information = at.information;
  result.gradient = at.gradient;
  result.spurious_information = at.spurious;
  result.num_matched = at.num_matched;
  result.inlier_ratio = static_cast<double>(at.num_inliers) / result.num_points;
  if (result.inlier_ratio < params.min_inlier_ratio) result.status = MatchStatus::kPoorFit;
  return result;
}

}  // namespace corridor::matching
