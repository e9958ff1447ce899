#include "bench/metrics/association.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace corridor::metrics {
namespace {

// A pose of one trajectory beside a pose of the other, with nothing between them in time.
struct Neighbours {
  std::int64_t dt_ns = 0;
  std::size_t estimate_index = 0;
  std::size_t truth_index = 0;
};

std::int64_t distance_ns(Timestamp a, Timestamp b) {
  return std::abs(a.nanoseconds - b.nanoseconds);
}

// The two of a closest pair stand next to each other in the merged order of both trajectories, so
// only such neighbours can ever be a pair that crosses no other.
std::vector<Neighbours> neighbours_in_merged_order(const Trajectory& estimate,
                                                   const Trajectory& truth) {
  std::vector<Neighbours> neighbours;
  std::size_t e = 0;
  std::size_t t = 0;
  while (e < estimate.size() && t < truth.size()) {
    // Here the poses before e and t are merged; e and t face each other if one of them is next and
    // the other follows it at once.
    const bool is_estimate_next = estimate[e].stamp <= truth[t].stamp;
    const bool are_adjacent =
        is_estimate_next ? e + 1 == estimate.size() || truth[t].stamp < estimate[e + 1].stamp
                         : t + 1 == truth.size() || estimate[e].stamp <= truth[t + 1].stamp;
    if (are_adjacent) neighbours.push_back({distance_ns(estimate[e].stamp, truth[t].stamp), e, t});
    ++(is_estimate_next ? e : t);
  }
  return neighbours;
}

void associate_nearest(const Trajectory& estimate, const Trajectory& truth, Association& result) {
  auto neighbours = neighbours_in_merged_order(estimate, truth);
  std::stable_sort(neighbours.begin(), neighbours.end(),
                   [](const Neighbours& a, const Neighbours& b) { return a.dt_ns < b.dt_ns; });
  std::vector<bool> is_estimate_used(estimate.size()), is_truth_used(truth.size());
  for (const Neighbours& pair : neighbours) {
    const auto [dt_ns, e, t] = pair;
    if (!(static_cast<double>(dt_ns) <= result.max_dt_s * kNanosecondsPerSecond)) break;
    if (is_estimate_used[e] || is_truth_used[t]) continue;
    is_estimate_used[e] = is_truth_used[t] = true;
    result.pairs.push_back({truth[t].stamp, estimate[e].T_map_base, truth[t].T_map_base});
  }
  std::sort(result.pairs.begin(), result.pairs.end(),
            [](const MatchedPose& a, const MatchedPose& b) { return a.stamp < b.stamp; });
  result.num_estimate_matched = result.num_truth_matched = result.pairs.size();
}

void associate_interpolated(const Trajectory& estimate, const Trajectory& truth,
                            Association& result) {
  std::vector<bool> is_truth_used(truth.size());
  std::size_t later = 0;  // first true pose at or after the stamp
  for (const TrajectoryPose& pose : estimate.poses()) {
    while (later < truth.size() && truth[later].stamp < pose.stamp) ++later;
    if (later == truth.size()) break;
    const bool is_equal = truth[later].stamp == pose.stamp;
    if (!is_equal && later == 0) continue;
    const std::size_t earlier = is_equal ? later : later - 1;
    const double gap_s = std::max(seconds_between(truth[earlier].stamp, pose.stamp),
                                  seconds_between(pose.stamp, truth[later].stamp));
    const auto T_world_base = truth.interpolate(pose.stamp);
    if (!(gap_s <= result.max_dt_s) || !T_world_base) continue;
    is_truth_used[earlier] = is_truth_used[later] = true;
    result.pairs.push_back({pose.stamp, pose.T_map_base, *T_world_base});
  }
  result.num_estimate_matched = result.pairs.size();
  result.num_truth_matched =
      static_cast<std::size_t>(std::count(is_truth_used.begin(), is_truth_used.end(), true));
}

}  // namespace

std::string_view to_text(AssociationRule rule) {
  return rule == AssociationRule::kNearest ? "nearest" : "interpolate";
}

std::optional<AssociationRule> association_rule_from_text(std::string_view text) {
  for (const auto rule : {AssociationRule::kNearest, AssociationRule::kInterpolate}) {
    if (text == to_text(rule)) return rule;
  }
  return std::nullopt;
}

Association associate(const Trajectory& estimate, const Trajectory& truth, AssociationRule rule,
                      double max_dt_s) {
  Association result;
  result.rule = rule;
  result.max_dt_s = max_dt_s;
  if (rule == AssociationRule::kNearest) {
    associate_nearest(estimate, truth, result);
  } else {
    associate_interpolated(estimate, truth, result);
  }
  result.num_estimate_unmatched = estimate.size() - result.num_estimate_matched;
  result.num_truth_unmatched = truth.size() - result.num_truth_matched;
  return result;
}

std::optional<std::size_t> nearest_pose(const Trajectory& trajectory, Timestamp stamp,
                                        double max_dt_s) {
  if (trajectory.empty()) return std::nullopt;
  const auto& poses = trajectory.poses();
  auto nearest =
      std::lower_bound(poses.begin(), poses.end(), stamp,
                       [](const TrajectoryPose& pose, Timestamp t) { return pose.stamp < t; });
  const bool is_earlier_nearer =
      nearest != poses.begin() &&
      (nearest == poses.end() ||
       distance_ns(std::prev(nearest)->stamp, stamp) <= distance_ns(nearest->stamp, stamp));
  if (is_earlier_nearer) --nearest;
  const double dt_s = std::abs(seconds_between(nearest->stamp, stamp));
  if (!(dt_s <= max_dt_s)) return std::nullopt;
  return static_cast<std::size_t>(nearest - poses.begin());
}

}  // namespace corridor::metrics
