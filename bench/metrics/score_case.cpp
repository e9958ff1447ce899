#include "bench/metrics/score_case.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "bench/metrics/key_distances.hpp"
#include "bench/metrics/map_cloud.hpp"
#include "bench/metrics/relations.hpp"
#include "bench/metrics/trajectory_errors.hpp"

namespace corridor::metrics {
namespace {

// Fewer matches than this share of what could match are worth a word.
constexpr double kFewMatchesRatio = 0.5;

Trajectory at_stamps(std::span<const Timestamp> stamps) {
  Trajectory trajectory;
  for (const Timestamp stamp : stamps) {
    // A stamp that repeats the last one cannot be a second scan to be matched.
    static_cast<void>(trajectory.append({stamp, Pose2(), std::nullopt}));
  }
  return trajectory;
}

// The scans for which a pose is expected: those with a true pose, if there is a truth.
Trajectory expected_poses(const CaseEvidence& evidence, const ScoringOptions& options) {
  if (evidence.scan_stamps.empty()) {
    return evidence.truth_world != nullptr ? *evidence.truth_world : Trajectory();
  }
  Trajectory scans = at_stamps(evidence.scan_stamps);
  if (evidence.truth_world == nullptr) return scans;
  const auto matched =
      associate(scans, *evidence.truth_world, options.association, options.max_dt_s);
  Trajectory expected;
  for (const MatchedPose& pair : matched.pairs) {
    static_cast<void>(expected.append({pair.stamp, pair.T_world_base, std::nullopt}));
  }
  return expected;
}

void count_poses(const CaseEvidence& evidence, const ScoringOptions& options,
                 results::RunResult& result, std::vector<std::string>& remarks) {
  const Trajectory expected = expected_poses(evidence, options);
  if (expected.empty() && evidence.scan_stamps.empty()) return;
  std::size_t num_matched = 0;
  if (evidence.final_trajectory != nullptr) {
    num_matched =
        associate(*evidence.final_trajectory, expected, AssociationRule::kNearest, options.max_dt_s)
            .pairs.size();
  }
  result.poses_expected = static_cast<std::int64_t>(expected.size());
  result.poses_matched = static_cast<std::int64_t>(num_matched);
  const auto num_scans = evidence.scan_stamps.size();
  if (static_cast<double>(expected.size()) < kFewMatchesRatio * static_cast<double>(num_scans)) {
    remarks.push_back(fmt::format(
        "only {} of {} scans have a true pose within {} s: are stamps in another unit or clock?",
        expected.size(), num_scans, options.max_dt_s));
  }
  // Without any pose the status says so; stamps are in question only if there are some.
  const bool has_poses =
      evidence.final_trajectory != nullptr && !evidence.final_trajectory->empty();
  if (has_poses &&
      static_cast<double>(num_matched) < kFewMatchesRatio * static_cast<double>(expected.size())) {
    remarks.push_back(fmt::format(
        "only {} of {} expected poses were given within {} s: are stamps in another unit or clock?",
        num_matched, expected.size(), options.max_dt_s));
  }
}

void score_one_trajectory(const Trajectory* trajectory, const CaseEvidence& evidence,
                          const ScoringOptions& options, results::TrajectoryScores& scores,
                          results::RelationScores& relations) {
  scores = {};
  relations = {};
  if (trajectory == nullptr) return;
  if (evidence.truth_world != nullptr) {
    scores = score_trajectory(
        associate(*trajectory, *evidence.truth_world, options.association, options.max_dt_s),
        options.alignment);
  }
  relations = score_relations(*trajectory, evidence.relations, options.max_dt_s);
}

results::MapScores score_map(const GridMap* map, const CaseEvidence& evidence) {
  results::MapScores scores;
  const bool is_scorable = map != nullptr && evidence.final_trajectory != nullptr &&
                           evidence.truth_world != nullptr && evidence.world != nullptr;
  if (!is_scorable) return scores;
  if (evidence.world->corridor) {
    scores.key_distances =
        measure_key_distances(*map, *evidence.final_trajectory, *evidence.truth_world,
                              *evidence.world, evidence.lidar_range_m);
  }
  const auto distances = score_map_cloud(*map, *evidence.final_trajectory, *evidence.truth_world,
                                         *evidence.world, evidence.lidar_range_m);
  if (distances) {
    scores.map_chamfer_m = distances->chamfer_m;
    scores.map_hausdorff95_m = distances->hausdorff95_m;
  }
  return scores;
}

}  // namespace

std::vector<std::string> score_case(const CaseEvidence& evidence, const ScoringOptions& options,
                                    results::RunResult& result) {
  std::vector<std::string> remarks;
  result.poses_expected.reset();
  result.poses_matched.reset();
  count_poses(evidence, options, result, remarks);
  result.association.reset();
  result.alignment.reset();
  if (evidence.truth_world != nullptr) {
    result.association = to_text(options.association);
    result.alignment = to_text(options.alignment);
  }
  score_one_trajectory(evidence.final_trajectory, evidence, options, result.final_scores,
                       result.final_relations);
  score_one_trajectory(evidence.online_trajectory, evidence, options, result.online_scores,
                       result.online_relations);
  result.own_map = score_map(evidence.own_map, evidence);
  result.rendered_map = score_map(evidence.rendered_map, evidence);
  return remarks;
}

}  // namespace corridor::metrics
