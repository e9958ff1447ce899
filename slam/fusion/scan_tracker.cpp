#include "slam/fusion/scan_tracker.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>

#include "slam/fusion/majority_vote.hpp"

namespace corridor::fusion {
namespace {

struct Spread {
  double sigma_m, sigma_rad;
  [[nodiscard]] Eigen::Vector3d variances() const {
    return Eigen::Vector3d(sigma_m, sigma_m, sigma_rad).cwiseAbs2();
  }
};

Spread near_spread(const FusionParams& params) {
  return {params.match_prior_sigma_m, params.match_prior_sigma_rad};
}
Spread far_spread(const FusionParams& params) {
  return {params.retry_prior_sigma_m, params.retry_prior_sigma_rad};
}

// What holds a match on the fine surfels: their basin is no wider than the far spread, however bad
// the prediction is.
Eigen::Matrix3d near_information(const Eigen::Matrix3d& covariance, const FusionParams& params) {
  return covariance.diagonal()
      .cwiseMax(near_spread(params).variances())
      .cwiseMin(far_spread(params).variances())
      .cwiseInverse()
      .asDiagonal();
}

Eigen::Matrix3d far_information(const Eigen::Matrix3d& covariance, const FusionParams& params) {
  return covariance.diagonal().cwiseMax(far_spread(params).variances()).cwiseInverse().asDiagonal();
}

// The match near the prediction, unless one from further away explains more of the scan.
matching::MatchResult match_or_search(Submap& submap, std::span<const Eigen::Vector2d> points_base,
                                      const Pose2& T_predicted, const Eigen::Matrix3d& covariance,
                                      const Eigen::Matrix3d& held, double range_sigma_m,
                                      const FusionParams& params) {
  matching::MatchResult best = submap.match_near(points_base, T_predicted, held, range_sigma_m);
  const auto explains_enough = [&] {
    return best.is_usable() && best.inlier_ratio >= params.retry_inlier_ratio;
  };
  const auto consider = [&](const matching::MatchResult& other) {
    if (!other.is_usable()) return;
    if (best.is_usable() && other.inlier_ratio < best.inlier_ratio + params.retry_gain_ratio)
      return;
    best = other;
  };
  if (explains_enough()) return best;
  consider(
      submap.match(points_base, T_predicted, far_information(covariance, params), range_sigma_m));
  if (explains_enough() || params.retry_window_m <= 0) return best;
  consider(submap.search(points_base, T_predicted, params.retry_window_m, params.retry_window_rad,
                         Eigen::Matrix3d::Zero(), range_sigma_m));
  return best;
}

// Matches again, held at the prediction along what the last match did not see.
matching::MatchResult hold_unseen(matching::MatchResult match, Submap& submap,
                                  std::span<const Eigen::Vector2d> points_base,
                                  const Pose2& T_predicted, const Eigen::Matrix3d& held,
                                  double range_sigma_m, const FusionParams& params) {
  for (int i = 0; i < params.hold_unseen_passes && match.is_usable(); ++i) {
    const Eigen::Matrix3d unseen = matching::unseen_information(match, params.observability);
    if (unseen.isZero()) break;
    const matching::MatchResult again =
        submap.match_near(points_base, T_predicted, held + unseen, range_sigma_m);
    // Where it explains less, the prediction lies in a basin that the search had to leave.
    const double least_ratio = std::min(match.inlier_ratio, params.retry_inlier_ratio);
    if (!again.is_usable() || again.inlier_ratio < least_ratio) break;
    match = again;
  }
  return match;
}

constexpr double kAnyTurn_rad2 = 10;

struct Fused {
  Pose2 T_submap_base;
  double chi2 = 0;
};

// Kalman update in information form; directions with zero information stay as predicted. chi2 is
// the innovation's, (L^+ + Q)^-1 by the matrix inversion lemma, L the match's information, Q the
// prediction's covariance.
Fused fuse(const Pose2& T_predicted, const matching::ObservableMatch& match,
           const Eigen::Matrix3d& covariance) {
  const Pose2::Tangent innovation = match.T_map_base.minus(T_predicted);
  const Eigen::Vector3d pull = match.information * innovation;
  const Eigen::Vector3d gain =
      (match.information + Eigen::Matrix3d(covariance.inverse())).ldlt().solve(pull);
  return {T_predicted.plus(gain), innovation.dot(pull) - pull.dot(gain)};
}

}  // namespace

std::optional<matching::ObservableMatch> match_again(Submap& submap,
                                                     std::span<const Eigen::Vector2d> points_base_m,
                                                     const Pose2& T_submap_base,
                                                     const RobotModel& robot,
                                                     const FusionParams& params) {
  const double range_sigma_m = robot.lidar.range_sigma_m;
  const Eigen::Matrix3d held = near_information(Eigen::Matrix3d::Zero(), params);
  const matching::MatchResult match =
      hold_unseen(submap.match_near(points_base_m, T_submap_base, held, range_sigma_m), submap,
                  points_base_m, T_submap_base, held, range_sigma_m, params);
  if (!match.is_usable() || match.inlier_ratio < params.retry_inlier_ratio) return std::nullopt;
  return matching::observable_part(match, params.observability);
}

TrackedScan track_scan(Submap& submap, std::span<const Eigen::Vector2d> points_base_m,
                       const Pose2& T_submap_last, const Prediction& prediction,
                       const RobotModel& robot, const FusionParams& params, bool may_refuse) {
  const Pose2 T_predicted = T_submap_last * prediction.T_last_now;
  TrackedScan tracked;
  tracked.T_submap_base = T_predicted;
  const Eigen::Matrix3d held = near_information(prediction.covariance, params);
  const double range_sigma_m = robot.lidar.range_sigma_m;
  const matching::MatchResult match =
      hold_unseen(match_or_search(submap, points_base_m, T_predicted, prediction.covariance, held,
                                  range_sigma_m, params),
                  submap, points_base_m, T_predicted, held, range_sigma_m, params);
  if (!match.is_usable()) return tracked;
  const matching::ObservableMatch seen = matching::observable_part(match, params.observability);
  tracked.match = put_to_vote(seen, T_submap_last, prediction, params);
  tracked.num_outvoted = seen.num_observable - tracked.match->num_observable;
  // The pose at the last scan came from a match of the same kind: its error counts too.
  Eigen::Matrix3d covariance = prediction.covariance;
  covariance.diagonal() += matching::floor_sigma(params.observability).cwiseAbs2();
  Fused fused = fuse(T_predicted, *tracked.match, covariance);
  if (prediction.has_wheels) {
    tracked.wheel_chi2 = fused.chi2;
    tracked.wheel_degrees_of_freedom = tracked.match->num_observable;
    if (prediction.is_turn_by_gyro) {
      // A turn of any size costs nothing: what remains is the wheels' own error.
      Eigen::Matrix3d free_turn = covariance;
      free_turn(2, 2) += kAnyTurn_rad2;
      tracked.wheel_chi2 = fuse(T_predicted, *tracked.match, free_turn).chi2;
      tracked.wheel_degrees_of_freedom = std::max(tracked.match->num_observable - 1, 0);
    }
  }
  const bool is_jump = params.use_statistical_slip_test && fused.chi2 > params.slip_gate;
  if (is_jump && may_refuse && match.inlier_ratio < params.jump_inlier_ratio) {
    // Either the scan is spoilt (somebody stands before it) or the wheels jumped: the next tells.
    TrackedScan refused;
    refused.T_submap_base = T_predicted;
    refused.is_refused = true;
    return refused;
  }
  // Wheels that jumped do not hold the scan back.
  if (is_jump) {
    fused = fuse(T_predicted, *tracked.match, covariance * fused.chi2);
  }
  tracked.T_submap_base = fused.T_submap_base;
  return tracked;
}

}  // namespace corridor::fusion
