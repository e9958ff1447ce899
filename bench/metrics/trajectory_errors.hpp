// Absolute and relative pose errors of a trajectory [Sturm2012], as evo defines them, and the six
// numbers a run is judged by. T_i is the true pose i, E_i the estimated one, aligned. It does not
// choose which poses are compared (association.hpp).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "bench/metrics/alignment.hpp"
#include "bench/metrics/association.hpp"
#include "bench/results/run_result.hpp"

namespace corridor::metrics {

struct PoseErrors {
  std::vector<double> translation_m;
  std::vector<double> rotation_deg;  // absolute, in [0, 180]
};

struct ErrorStatistics {
  double rmse = 0, mean = 0, median = 0, std = 0, min = 0, max = 0,
         sse = 0;  // std: of the population
  std::size_t num_errors = 0;
};

// nullopt for no errors.
std::optional<ErrorStatistics> summarise(std::span<const double> errors);

// APE: T_i^-1 E_i for each pair; length of its translation, size of its angle. Empty if align()
// fails.
PoseErrors absolute_pose_errors(const Association& association, Alignment alignment);

enum class PairSelection {
  kConsecutive,  // (0, d), (d, 2 d), ...
  kAll,          // (0, d), (1, d + 1), ...
};

// RPE over delta_frames > 0 matched pairs: (T_i^-1 T_j)^-1 (E_i^-1 E_j). Needs no alignment.
PoseErrors relative_pose_errors(const Association& association, std::size_t delta_frames,
                                PairSelection selection);

// A pair longer than this many times the wanted length spans a gap in the truth and is left out.
inline constexpr double kMaxPathRatio = 1.5;

// RPE over a length of true path. For every matched pose i: j is the first later one with s_j - s_i
// >= length_m, s being the summed distances between consecutive matched true positions; the pair
// (i, j) is used if s_j - s_i <= kMaxPathRatio * length_m. Pairs overlap; errors are not divided by
// their length.
PoseErrors relative_pose_errors_over_path(const Association& association, double length_m);

// position_rmse_m, angle_rmse_deg: RMSE of the APE after `alignment` (the paper's two, with
// kOrigin); ate_se2_*: the same after kSe2; rpe_1m_*: over 1 m of path. All null for fewer than two
// pairs, since the first pair has error zero by construction; single ones null where they are not
// defined.
results::TrajectoryScores score_trajectory(const Association& association,
                                           Alignment alignment = Alignment::kOrigin);

}  // namespace corridor::metrics
