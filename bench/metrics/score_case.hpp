// All scores of one case, from what the system left and what is known about the data.
// It does not run anything and does not decide the case's status.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/metrics/alignment.hpp"
#include "bench/metrics/association.hpp"
#include "bench/results/run_result.hpp"
#include "datasets/formats/trajectories/relations.hpp"
#include "datasets/simulation/world.hpp"
#include "slam/core/grid_map.hpp"
#include "slam/core/timestamp.hpp"
#include "slam/core/trajectory.hpp"

namespace corridor::metrics {

// What is scored; everything that is null or empty is unknown or absent, and its scores stay null.
struct CaseEvidence {
  const Trajectory* final_trajectory = nullptr;
  const Trajectory* online_trajectory = nullptr;
  const GridMap* own_map = nullptr;        // the system's own, in the frame of the final trajectory
  const GridMap* rendered_map = nullptr;   // the common mapper's map of the final trajectory
  std::span<const Timestamp> scan_stamps;  // of the log; empty = unknown (evaluation of bare files)
  const Trajectory* truth_world = nullptr;
  std::span<const formats::Relation> relations;
  const simulation::World* world = nullptr;  // maps are scored only with truth and world
  double lidar_range_m = 0;
};

struct ScoringOptions {
  AssociationRule association = AssociationRule::kNearest;
  Alignment alignment = Alignment::kOrigin;  // of position_rmse_m and angle_rmse_deg
  double max_dt_s = kDefaultMaxDt_s;
};

// Fills poses_expected, poses_matched, association, alignment, {final,online}_{scores,relations},
// own_map and rendered_map of `result` and leaves the rest alone.
// poses_expected: the scans for which there is a true pose (all scans where there is no truth; all
// true poses where the scans are unknown); poses_matched: those of them at which the final
// trajectory has a pose. Returns what a reader of the scores should know, one line each ("only 1 of
// 616 scans has a true pose within 0.01 s: are stamps in another unit?"); empty = nothing.
std::vector<std::string> score_case(const CaseEvidence& evidence, const ScoringOptions& options,
                                    results::RunResult& result);

}  // namespace corridor::metrics
