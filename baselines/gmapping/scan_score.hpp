// How well a scan fits a particle's map: the score the hill climb maximises and the log-likelihood
// that weighs the particle. Both compare each end point with the nearest cell mean around it.
// The test for a free cell in front of the end point is made where the parameters ask for it. The
// original has it, but looks the cell up half a map away, where it always passes: without it the
// result is bit-identical.
#pragma once

#include "baselines/gmapping/end_point_map.hpp"
#include "baselines/gmapping/gmapping_params.hpp"
#include "baselines/gmapping/scan_points.hpp"
#include "slam/core/pose2.hpp"

namespace corridor::gmapping {

// Log-likelihood of an end point without a mean nearby, times likelihood_sigma_m2 [m^2].
inline constexpr double kUnmatchedM2 = 0.5;

// Sum over the points of exp(-d^2 / score_sigma_m2), d = distance to the nearest mean among the
// cells within the kernel; a point with no such cell adds exactly 0. Between 0 and the number of
// points.
double scan_score(const EndPointMap& map, const ScanPoints& points, const Pose2& T_map_base,
                  const GmappingParams& params);

// Sum over the points of -d^2 / likelihood_sigma_m2, or -kUnmatchedM2 / likelihood_sigma_m2 where
// there is no such cell. Neither normalised nor divided by the number of points.
double scan_log_likelihood(const EndPointMap& map, const ScanPoints& points,
                           const Pose2& T_map_base, const GmappingParams& params);

}  // namespace corridor::gmapping
