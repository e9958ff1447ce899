#include "bench/metrics/trajectory_errors.hpp"

#include <algorithm>
#include <cmath>

#include "bench/statistics/quantiles.hpp"
#include "slam/core/units.hpp"

namespace corridor::metrics {
namespace {

constexpr double kRelativePath_m = 1;

void append_error(const Pose2& error, PoseErrors& errors) {
  errors.translation_m.push_back(error.translation_m().norm());
  errors.rotation_deg.push_back(std::abs(error.theta_rad()) * kDegPerRad);
}

// [Sturm2012] eq. 1: (T_i^-1 T_j)^-1 (E_i^-1 E_j).
void append_relative_error(const MatchedPose& from, const MatchedPose& to, PoseErrors& errors) {
  const Pose2 true_motion = from.T_world_base.between(to.T_world_base);
  append_error(true_motion.between(from.T_map_base.between(to.T_map_base)), errors);
}

std::vector<double> true_path_m(const std::vector<MatchedPose>& pairs) {
  std::vector<double> path_m(pairs.size(), 0.0);
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    path_m[i] =
        path_m[i - 1] +
        (pairs[i].T_world_base.translation_m() - pairs[i - 1].T_world_base.translation_m()).norm();
  }
  return path_m;
}

std::optional<double> rmse(const std::vector<double>& errors) {
  const auto statistics = summarise(errors);
  return statistics ? std::optional(statistics->rmse) : std::nullopt;
}

}  // namespace

std::optional<ErrorStatistics> summarise(std::span<const double> errors) {
  if (errors.empty()) return std::nullopt;
  const auto n = static_cast<double>(errors.size());
  ErrorStatistics result;
  result.num_errors = errors.size();
  result.min = *std::min_element(errors.begin(), errors.end());
  result.max = *std::max_element(errors.begin(), errors.end());
  double sum = 0;
  for (const double error : errors) {
    sum += error;
    result.sse += error * error;
  }
  result.mean = sum / n;
  result.rmse = std::sqrt(result.sse / n);
  double sum_of_squared_deviations = 0;
  for (const double error : errors) {
    sum_of_squared_deviations += (error - result.mean) * (error - result.mean);
  }
  result.std = std::sqrt(sum_of_squared_deviations / n);
  const auto median = statistics::median(errors);
  if (!median) return std::nullopt;  // an error that is not a number
  result.median = *median;
  return result;
}

PoseErrors absolute_pose_errors(const Association& association, Alignment alignment) {
  PoseErrors errors;
  const auto T_world_map = align(association.pairs, alignment);
  if (!T_world_map) return errors;
  for (const MatchedPose& pair : association.pairs) {
    append_error(pair.T_world_base.between(*T_world_map * pair.T_map_base), errors);
  }
  return errors;
}

PoseErrors relative_pose_errors(const Association& association, std::size_t delta_frames,
                                PairSelection selection) {
  PoseErrors errors;
  if (delta_frames == 0) return errors;
  const auto& pairs = association.pairs;
  const std::size_t step = selection == PairSelection::kAll ? 1 : delta_frames;
  for (std::size_t i = 0; i + delta_frames < pairs.size(); i += step) {
    append_relative_error(pairs[i], pairs[i + delta_frames], errors);
  }
  return errors;
}

PoseErrors relative_pose_errors_over_path(const Association& association, double length_m) {
  PoseErrors errors;
  if (!(length_m > 0)) return errors;
  const auto& pairs = association.pairs;
  const auto path_m = true_path_m(pairs);
  std::size_t j = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    while (j < pairs.size() && path_m[j] - path_m[i] < length_m) ++j;
    if (j == pairs.size()) break;
    if (path_m[j] - path_m[i] > kMaxPathRatio * length_m) continue;
    append_relative_error(pairs[i], pairs[j], errors);
  }
  return errors;
}

results::TrajectoryScores score_trajectory(const Association& association, Alignment alignment) {
  results::TrajectoryScores scores;
  if (association.pairs.size() < 2) return scores;
  const auto absolute = absolute_pose_errors(association, alignment);
  scores.position_rmse_m = rmse(absolute.translation_m);
  scores.angle_rmse_deg = rmse(absolute.rotation_deg);
  const auto absolute_se2 = absolute_pose_errors(association, Alignment::kSe2);
  scores.ate_se2_rmse_m = rmse(absolute_se2.translation_m);
  scores.ate_se2_angle_rmse_deg = rmse(absolute_se2.rotation_deg);
  const auto relative = relative_pose_errors_over_path(association, kRelativePath_m);
  scores.rpe_1m_rmse_m = rmse(relative.translation_m);
  scores.rpe_1m_angle_rmse_deg = rmse(relative.rotation_deg);
  return scores;
}

}  // namespace corridor::metrics
