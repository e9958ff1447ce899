// Which pose of an estimated trajectory is compared with which true pose.
// One-to-one, and what stayed without a partner is counted: a score without its coverage lies.
// It does not align frames and does not estimate clock offsets.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "slam/core/pose2.hpp"
#include "slam/core/timestamp.hpp"
#include "slam/core/trajectory.hpp"

namespace corridor::metrics {

enum class AssociationRule {
  // Closest stamps first, each pose used at most once, pairs never cross in time: among neighbours
  // in
  // the merged order of both trajectories. A pair has the stamp of the truth.
  kNearest,
  // The truth is interpolated on its geodesic at each stamp of the estimate, if both of its
  // neighbours
  // there are within max_dt_s of the stamp (an equal stamp needs none). A pair has the estimate's
  // stamp.
  kInterpolate,
};

// "nearest", "interpolate".
std::string_view to_text(AssociationRule rule);
std::optional<AssociationRule> association_rule_from_text(std::string_view text);

// Estimates at the stamps of the scans meet their truth within rounding; 10 ms is far below the
// period of any LiDAR of the suite.
inline constexpr double kDefaultMaxDt_s = 0.01;

struct MatchedPose {
  Timestamp stamp;
  Pose2 T_map_base;    // as estimated
  Pose2 T_world_base;  // true
};

struct Association {
  AssociationRule rule = AssociationRule::kNearest;
  double max_dt_s = kDefaultMaxDt_s;
  std::vector<MatchedPose> pairs;  // stamps strictly increase
  std::size_t num_estimate_matched = 0, num_estimate_unmatched = 0;
  // kInterpolate: a true pose counts as matched if a pair was interpolated from it.
  std::size_t num_truth_matched = 0, num_truth_unmatched = 0;
};

// max_dt_s < 0 or NaN matches nothing. Stamps in the wrong unit show as num_truth_unmatched.
Association associate(const Trajectory& estimate, const Trajectory& truth, AssociationRule rule,
                      double max_dt_s = kDefaultMaxDt_s);

// Index of the pose whose stamp is nearest (the earlier of two equally near), if within max_dt_s.
std::optional<std::size_t> nearest_pose(const Trajectory& trajectory, Timestamp stamp,
                                        double max_dt_s);

}  // namespace corridor::metrics
