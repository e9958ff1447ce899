#include "bench/metrics/relations.hpp"

#include <cmath>
#include <cstdint>

#include "bench/metrics/association.hpp"
#include "slam/core/units.hpp"

namespace corridor::metrics {

PoseErrors relation_errors(const Trajectory& estimate, std::span<const formats::Relation> relations,
                           double max_dt_s) {
  PoseErrors errors;
  for (const formats::Relation& relation : relations) {
    const auto first = nearest_pose(estimate, relation.t1, max_dt_s);
    const auto second = nearest_pose(estimate, relation.t2, max_dt_s);
    if (!first || !second) continue;
    const Pose2 motion = estimate[*first].T_map_base.between(estimate[*second].T_map_base);
    const Pose2 error = relation.T_1_2.between(motion);
    errors.translation_m.push_back(error.translation_m().norm());
    errors.rotation_deg.push_back(std::abs(error.theta_rad()) * kDegPerRad);
  }
  return errors;
}

results::RelationScores score_relations(const Trajectory& estimate,
                                        std::span<const formats::Relation> relations,
                                        double max_dt_s) {
  results::RelationScores scores;
  if (relations.empty()) return scores;
  const PoseErrors errors = relation_errors(estimate, relations, max_dt_s);
  const auto num_used = static_cast<std::int64_t>(errors.translation_m.size());
  scores.relations_used = num_used;
  scores.relations_skipped = static_cast<std::int64_t>(relations.size()) - num_used;
  if (const auto translation = summarise(errors.translation_m)) {
    scores.relations_translation_mean_m = translation->mean;
    scores.relations_translation_std_m = translation->std;
  }
  if (const auto rotation = summarise(errors.rotation_deg)) {
    scores.relations_rotation_mean_deg = rotation->mean;
    scores.relations_rotation_std_deg = rotation->std;
  }
  return scores;
}

}  // namespace corridor::metrics
