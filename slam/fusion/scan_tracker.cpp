#include "slam/fusion/scan_tracker.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace corridor::fusion {
namespace {

// A search must explain this much more of the scan than the prediction's own match to be believed.
constexpr double kMinImprovement = 0.1;

matching::MatchResult match_or_search(Submap& submap, std::span<const Eigen::Vector2d> points_base,
                                      const Pose2& T_predicted, const Eigen::Matrix3d& information,
                                      double range_sigma_m, const FusionParams& params) {
  matching::MatchResult direct =
      submap.match(points_base, T_predicted, information, range_sigma_m);
  if (direct.is_usable() && direct.inlier_ratio >= params.retry_inlier_ratio) return direct;
  if (params.retry_window_m <= 0) return direct;
  matching::MatchResult searched =
      submap.search(points_base, T_predicted, params.retry_window_m, params.retry_window_rad,
                    Eigen::Matrix3d::Zero(), range_sigma_m);
  const bool is_better =
      searched.is_usable() && searched.inlier_ratio > direct.inlier_ratio + kMinImprovement;
  return is_better ? searched : direct;
}

std::optional<double> innovation_square(const Pose2& T_predicted,
                                        const matching::ObservableMatch& match,
                                        const Prediction& prediction) {
  if (match.num_observable < 3 || !prediction.has_wheels) return std::nullopt;
  const Pose2::Tangent innovation = match.T_map_base.minus(T_predicted);
  // The pose at the last scan came from a match of the same kind: its covariance counts once more.
  const Eigen::Matrix3d covariance = 2 * match.information.inverse() + prediction.covariance;
  return innovation.dot(covariance.llt().solve(innovation)) / 3;
}

}  // namespace

TrackedScan track_scan(Submap& submap, std::span<const Eigen::Vector2d> points_base_m,
                       const Pose2& T_submap_last, const Prediction& prediction,
                       const RobotModel& robot, const FusionParams& params) {
  const Pose2 T_predicted = T_submap_last * prediction.T_last_now;
  TrackedScan tracked;
  tracked.T_submap_base = T_predicted;
  const matching::MatchResult match =
      match_or_search(submap, points_base_m, T_predicted, prediction.covariance.inverse(),
                      robot.lidar.range_sigma_m, params);
  if (!match.is_usable()) return tracked;
  tracked.T_submap_base = match.T_map_base;
  tracked.match = matching::observable_part(match, params.observability);
  tracked.normalized_square = innovation_square(T_predicted, *tracked.match, prediction);
  return tracked;
}

}  // namespace corridor::fusion
