// Errors of relative poses against relations set up by hand [Kuemmerle2009].
// The metric needs no common frame and no dense truth. It does not weigh relations.
#pragma once

#include <span>

#include "bench/metrics/trajectory_errors.hpp"
#include "bench/results/run_result.hpp"
#include "datasets/formats/trajectories/relations.hpp"
#include "slam/core/trajectory.hpp"

namespace corridor::metrics {

// For each relation whose two stamps have a pose within max_dt_s (the nearest one; a pose may serve
// many relations): T_1_2^-1 (E_1^-1 E_2), its translation and the size of its angle. Others are
// skipped.
PoseErrors relation_errors(const Trajectory& estimate, std::span<const formats::Relation> relations,
                           double max_dt_s);

// Mean and population standard deviation of the two; used + skipped = all relations. All null for
// an empty list of relations; the means null where none could be used.
results::RelationScores score_relations(const Trajectory& estimate,
                                        std::span<const formats::Relation> relations,
                                        double max_dt_s = kDefaultMaxDt_s);

}  // namespace corridor::metrics
