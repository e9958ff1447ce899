#include "baselines/gmapping/proposal.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace corridor::gmapping {
namespace {

// -range, -range + step, ..., range
std::vector<double> lattice_axis(double range, double step) {
  const auto num_steps = static_cast<int>(std::floor(range / step + 1e-9));
  std::vector<double> offsets;
  for (int i = -num_steps; i <= num_steps; ++i) offsets.push_back(i * step);
  return offsets;
}

struct LatticePoint {
  Eigen::Vector3d offset;  // from the centre
  double log_target;
};

double squared_ratio(double difference, double sigma) {
  return sigma > 0 ? difference * difference / (sigma * sigma) : 0.0;
}

}  // namespace

GaussianProposal fit_proposal(const Pose2& centre, const GmappingParams& params,
                              const std::function<double(const Pose2&)>& log_target) {
  const auto linear_m = lattice_axis(params.proposal_linear_range_m, params.proposal_linear_step_m);
  const auto angular_rad =
      lattice_axis(params.proposal_angular_range_rad, params.proposal_angular_step_rad);
  std::vector<LatticePoint> points;
  double largest = -std::numeric_limits<double>::infinity();
  for (const double x_m : linear_m) {
    for (const double y_m : linear_m) {
      for (const double theta_rad : angular_rad) {
        const Pose2 pose(centre.x_m() + x_m, centre.y_m() + y_m, centre.theta_rad() + theta_rad);
        points.push_back({{x_m, y_m, theta_rad}, log_target(pose)});
        largest = std::max(largest, points.back().log_target);
      }
    }
  }
  // Relative to the largest, which keeps the exponentials in range.
  double sum = 0;
  Eigen::Vector3d first_moment = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second_moment = Eigen::Matrix3d::Zero();
  for (const LatticePoint& point : points) {
    const double weight = std::exp(point.log_target - largest);
    sum += weight;
    first_moment += weight * point.offset;
    second_moment += weight * point.offset * point.offset.transpose();
  }
  const Eigen::Vector3d mean_offset = first_moment / sum;
  return {.mean_map = Eigen::Vector3d(centre.x_m(), centre.y_m(), centre.theta_rad()) + mean_offset,
          .covariance_map = second_moment / sum - mean_offset * mean_offset.transpose(),
          .log_normaliser = largest + std::log(sum / static_cast<double>(points.size()))};
}

Pose2 draw_pose(const GaussianProposal& proposal, Rng& rng) {
  const Eigen::Vector3d normals(rng.normal(), rng.normal(), rng.normal());
  // P^T L D L^T P; rounding may leave a pivot just below zero.
  const Eigen::LDLT<Eigen::Matrix3d> factor(proposal.covariance_map);
  const Eigen::Vector3d scaled = factor.vectorD().cwiseMax(0).cwiseSqrt().cwiseProduct(normals);
  const Eigen::Vector3d offset =
      factor.transpositionsP().transpose() * (factor.matrixL() * scaled).eval();
  const Eigen::Vector3d pose = proposal.mean_map + offset;
  return {pose.x(), pose.y(), pose.z()};
}

double log_motion_density(const Pose2& T_map_before, const Pose2& T_map_after,
                          const Pose2& T_before_after, const MotionNoise& noise) {
  const Pose2 moved = T_map_before.between(T_map_after);
  const double turn_rad = wrap_angle(moved.theta_rad() - T_before_after.theta_rad());
  return -0.5 * (squared_ratio(moved.x_m() - T_before_after.x_m(), noise.x_m) +
                 squared_ratio(moved.y_m() - T_before_after.y_m(), noise.y_m) +
                 squared_ratio(turn_rad, noise.theta_rad));
}

}  // namespace corridor::gmapping
