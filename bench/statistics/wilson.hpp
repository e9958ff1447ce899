// The score interval of a success rate [Wilson1927], and the normal quantile it needs.
// Unlike the textbook interval it is not empty at 0 of n or n of n. No continuity correction.
#pragma once

#include <cstdint>
#include <optional>

#include "bench/statistics/estimate.hpp"

namespace corridor::statistics {

// x with P(X <= x) = probability for a standard normal X, to 1e-14. nullopt outside (0, 1).
std::optional<double> normal_quantile(double probability);

// p = successes / trials, z = normal_quantile((1 + confidence) / 2), n = trials:
//   (p + z^2 / (2 n) -+ z sqrt(p (1 - p) / n + z^2 / (4 n^2))) / (1 + z^2 / n).
// nullopt unless 0 <= successes <= trials, trials > 0, 0 < confidence < 1.
std::optional<Estimate> wilson_interval(std::int64_t successes, std::int64_t trials,
                                        double confidence = 0.95);

}  // namespace corridor::statistics
